// Configurations: whatever is wrong is a ConfigError; what is accepted reads back the same from its resolved form.
#include "dismantle/errors.h"
#include "dismantle/host/config.h"
#include "expect.h"
#include "input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dismantle;
  // A search path in the input must not load what lies about: the trial's folder is the working directory.
  static const bool moved = (std::filesystem::current_path(fuzz::scratch_folder()), true);
  FUZZ_EXPECT(moved);
  const auto file = fuzz::input_file("config.yaml", {data, size});
  try {
    Registry registry;
    const RunConfig config = load_config({file, {}, {}}, registry);
    const std::string text = resolved_yaml(config, registry, fuzz::scratch_folder());
    const auto again = fuzz::input_file(
        "resolved.yaml", {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    Registry other;
    FUZZ_EXPECT(resolved_yaml(load_config({again, {}, {}}, other), other, fuzz::scratch_folder()).size() > 0);
  } catch (const ConfigError& e) {
    FUZZ_EXPECT(!e.diagnostics().empty());
    for (const Diagnostic& d : e.diagnostics())  // what we wrote ourselves must be readable
      FUZZ_EXPECT(d.file.find("resolved.yaml") == std::string::npos);
  } catch (const PluginError&) {
  }
  return 0;
}
