// STEP files through the reader program, as the plugin reads them.
#include "dismantle/errors.h"
#include "input_file.h"
#include "raw_parts.h"
#include "step_importer.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dismantle;
  const auto file = fuzz::input_file("part.step", {data, size});
  step_import::StepParameters params;
  params.time_limit = 5;
  params.triangle_limit = 100'000;
  step_import::StepImporter importer(params, STEP_READER);
  try {
    fuzz::expect_sound(importer.read(file, {}));
  } catch (const InputError&) {
  }
  return 0;
}
