// step_seeds FOLDER: small STEP files to start from.
#include <cstdio>

#include "step_files.h"

int main(int argc, char** argv) {
  using namespace dismantle::step_import::testing;
  if (argc != 2) return 2;
  const std::filesystem::path folder = argv[1];
  StepFile one;
  one.product(box(1, 2, 3), "block");
  one.write(folder / "block.step");
  StepFile several;
  const auto block = several.product(box(2, 2, 1), "plate"), pin = several.product(cylinder(0.5, 2), "pin");
  several.paint(pin, {200, 10, 20, 255});
  const auto all = several.assembly("pair");
  several.place(all, block, moved(0, 0, 0), "base");
  several.place(all, pin, turned({1, 2, 3}, 0.3, {4, 0, 0}), "first");
  several.write(folder / "pair.step", "INCH");
  return 0;
}
