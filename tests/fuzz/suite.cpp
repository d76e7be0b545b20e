// Suites of benchmarks.
#include "dismantle/bench/suite.h"
#include "dismantle/errors.h"
#include "expect.h"
#include "input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dismantle;
  static const bool moved = (std::filesystem::current_path(fuzz::scratch_folder()), true);
  FUZZ_EXPECT(moved);
  const auto file = fuzz::input_file("suite.yaml", {data, size});
  try {
    const bench::Suite suite = bench::read_suite(file);
    const auto cells = bench::matrix(suite);
    for (const auto& cell : cells) FUZZ_EXPECT(cell.assembly < suite.assemblies.size());
  } catch (const ConfigError& e) {
    FUZZ_EXPECT(!e.diagnostics().empty());
  }
  return 0;
}
