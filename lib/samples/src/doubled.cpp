/// Two solids that fill the same space: a duplicate part, and a part inside the solid of another.
#include <algorithm>
#include <stdexcept>

#include "build.h"

namespace dismantle::samples {
namespace {

struct TwiceParameters {
  double length = 30, width = 20, thickness = 4, clearance = 0.1;
  static void describe(Schema<TwiceParameters>& s) {
    s.add("length", &TwiceParameters::length, {.unit = "mm", .min = 10, .max = 300, .doc = "Length of the plate."});
    s.add("width", &TwiceParameters::width, {.unit = "mm", .min = 10, .max = 300, .doc = "Width of the plate."});
    s.add("thickness", &TwiceParameters::thickness,
          {.unit = "mm", .min = 1, .max = 30, .doc = "Thickness of the plate."});
    add_clearance(s, 0.001, 0.5);
  }
};

Model same_plate_twice(const TwiceParameters& p) {
  Model model;
  model.clearance = p.clearance;
  const double x = p.length / 2, y = p.width / 2, t = p.thickness, c = p.clearance;
  Cells base;
  base.add(Point(-1.2 * x, -1.2 * y, -2 * t - c), Point(1.2 * x, 1.2 * y, -c));
  add_part(model, "base", base.mesh());
  Cells plate;
  plate.add(Point(-x, -y, 0), Point(x, y, t)).cut(Point(0.2 * x, 0.1 * y, 0), Point(0.6 * x, 0.7 * y, t));
  add_part(model, "plate", plate.mesh());
  add_part(model, "plate_again", plate.mesh());
  model.truth.contacts.push_back({"plate", "plate_again", ContactClass::duplicate, 0, 0, {}});
  return model;
}

struct InSolidParameters {
  double size = 40, insert = 8, offset = 0;
  static void describe(Schema<InSolidParameters>& s) {
    s.add("size", &InSolidParameters::size, {.unit = "mm", .min = 10, .max = 400, .doc = "Longest edge of the block."});
    s.add("insert", &InSolidParameters::insert,
          {.unit = "mm", .min = 1, .max = 100, .doc = "Edge of the cube in the block; at most a third of `size`."});
    s.add("offset", &InSolidParameters::offset,
          {.unit = "mm",
           .min = 0,
           .max = 200,
           .doc = "Distance of the cube from the centre of the block; the cube must stay in the block."});
  }
};

Model part_in_solid(const InSolidParameters& p) {
  const double half = p.size / 2, low = 0.3 * p.size, edge = p.insert / 2;
  if (p.insert > p.size / 3) throw std::invalid_argument("part_in_solid: insert is more than a third of size");
  if (p.offset + edge > 0.9 * half) throw std::invalid_argument("part_in_solid: the insert is not in the block");
  Model model;
  add_part(model, "block", Cells().add(Point(-half, -half, -low), Point(half, half, low)).mesh());
  add_part(model, "insert",
           Cells().add(Point(p.offset - edge, -edge, -edge), Point(p.offset + edge, edge, edge)).mesh());
  const double depth = std::min(low, half - std::max(0.0, p.offset - edge));
  model.truth.contacts.push_back({"insert", "block", ContactClass::inside, depth, 0, {}});
  return model;
}

}  // namespace

std::vector<Maker> doubled_makers() {
  const SampleFacts stays{.solvable = false, .clean = false};
  return {maker<TwiceParameters>("same_plate_twice", "A plate on a base, and the same plate again in its place.",
                                 &same_plate_twice, stays),
          maker<InSolidParameters>("part_in_solid", "A cube inside the solid of a block that has no cavity for it.",
                                   &part_in_solid, stays)};
}

}  // namespace dismantle::samples
