/// Rectilinear samples: slots that need several slides, and boxes with parts inside.
#include <cmath>

#include "build.h"

namespace dismantle::samples {
namespace {

struct LSlotParameters {
  double length = 15, width = 10, height = 8, travel = 20, wall = 5, clearance = 0.2;
  static void describe(Schema<LSlotParameters>& s) {
    s.add("length", &LSlotParameters::length,
          {.unit = "mm", .min = 5, .max = 200, .doc = "Size of the slider along x."});
    s.add("width", &LSlotParameters::width, {.unit = "mm", .min = 5, .max = 200, .doc = "Size of the slider along y."});
    s.add("height", &LSlotParameters::height,
          {.unit = "mm", .min = 5, .max = 200, .doc = "Size of the slider along z."});
    s.add("travel", &LSlotParameters::travel, {.unit = "mm", .min = 4, .max = 200, .doc = "First slide, along +x."});
    s.add("wall", &LSlotParameters::wall, {.unit = "mm", .min = 0.5, .max = 50, .doc = "Thickness of walls and roof."});
    add_clearance(s, 0.001, 0.5);
  }
};

Model l_slot(const LSlotParameters& p) {
  Model model;
  model.clearance = p.clearance;
  const Point size(p.length, p.width, p.height), c = Point::Constant(p.clearance), w = Point::Constant(p.wall);
  const Point displacement(p.travel, 0, 0), roof(0, 0, p.wall);
  Cells housing;
  housing.add(-c - w, size + displacement + c + w)
      .cut(-c, size + displacement + c)
      .cut(displacement - c, size + displacement + c + roof);
  add_part(model, "housing", housing.mesh());
  add_part(model, "slider", Cells().add(Point::Zero(), size).mesh());
  model.truth.steps.push_back(slide("slider", displacement, false));
  model.truth.steps.push_back(slide("slider", Point(0, 0, 1.2 * p.height + p.clearance + p.wall), true));
  return model;
}

struct ZigzagParameters {
  double size = 10, wall = 3, clearance = 0.2;
  int bends = 2;
  static void describe(Schema<ZigzagParameters>& s) {
    s.add("bends", &ZigzagParameters::bends,
          {.unit = "1", .min = 1, .max = 8, .doc = "Number of bends; each needs two slides."});
    s.add("size", &ZigzagParameters::size, {.unit = "mm", .min = 5, .max = 200, .doc = "Edge of the sliding block."});
    s.add("wall", &ZigzagParameters::wall,
          {.unit = "mm", .min = 0.5, .max = 50, .doc = "Thickness of the wall between two sections of the slot."});
    add_clearance(s, 0.001, 0.5);
  }
};

Model zigzag(const ZigzagParameters& p) {
  Model model;
  model.clearance = p.clearance;
  const Point size = Point::Constant(p.size), c = Point::Constant(p.clearance), w = Point::Constant(p.wall);
  const double across = 2 * p.size, up = p.size + 2 * p.clearance + p.wall;
  const Point top(across, 0, up * (p.bends - 1));
  Cells housing;
  housing.add(-c - w, size + top + c + w);
  Point at = Point::Zero();
  for (int bend = 0; bend < p.bends; ++bend) {
    const Point side(bend % 2 == 0 ? across : -across, 0, 0);
    const bool last = bend + 1 == p.bends;
    const Point level(0, 0, at.z());
    housing.cut(level - c, level + size + Point(across, 0, 0) + c);
    at += side;
    const Point rise(0, 0, last ? p.clearance + p.wall : up);
    housing.cut(at - c, at + size + rise + (last ? Point(p.clearance, p.clearance, 0) : c));
    model.truth.steps.push_back(slide("block", side, false));
    model.truth.steps.push_back(slide("block", last ? Point(rise + Point(0, 0, 1.2 * p.size)) : rise, last));
    at += rise;
  }
  add_part(model, "housing", housing.mesh());
  add_part(model, "block", Cells().add(Point::Zero(), size).mesh());
  return model;
}

struct StackedBoxParameters {
  int count = 3;
  double size = 60, plate = 6, wall = 4, clearance = 0.3;
  static void describe(Schema<StackedBoxParameters>& s) {
    s.add("count", &StackedBoxParameters::count, {.unit = "1", .min = 1, .max = 100, .doc = "Number of plates."});
    s.add("size", &StackedBoxParameters::size, {.unit = "mm", .min = 10, .max = 500, .doc = "Inner width of the box."});
    s.add("plate", &StackedBoxParameters::plate, {.unit = "mm", .min = 3, .max = 50, .doc = "Thickness of a plate."});
    s.add("wall", &StackedBoxParameters::wall,
          {.unit = "mm", .min = 0.5, .max = 50, .doc = "Thickness of walls, floor and lid."});
    add_clearance(s, 0.001, 0.5);
  }
};

Model stacked_box(const StackedBoxParameters& p) {
  Model model;
  model.clearance = p.clearance;
  model.truth.base = "box";
  const double half = p.size / 2, c = p.clearance, t = p.plate;
  const double boss = 0.4 * t, boss_half = p.size / 6;  // a boss on top of each plate sits in a pocket of the next
  const auto square = [](double h, double z) { return Point(h, h, z); };
  const auto low = [](double h, double z) { return Point(-h, -h, z); };
  // A slab with a pocket in its underside, from z up to z + height.
  const auto pocketed = [&](double h, double z, double height) {
    Cells cells;
    cells.add(low(h, z), square(h, z + height)).cut(low(boss_half + c, z), square(boss_half + c, z + boss));
    return cells;
  };
  const double stack_top = p.count * (t + c);  // top of the last plate without its boss; the top of the floor is at 0
  const double plug = boss + 0.2 * t, rim = stack_top + plug;
  Cells box;
  box.add(low(half + p.wall, -p.wall), square(half + p.wall, rim)).cut(low(half, 0), square(half, rim));
  add_part(model, "box", box.mesh());
  for (int k = 0; k < p.count; ++k) {
    const double z = c + k * (t + c);
    Cells plate = pocketed(half - c, z, t);
    plate.add(low(boss_half, z + t), square(boss_half, z + t + boss));
    add_part(model, "plate_" + std::to_string(k + 1), plate.mesh());
  }
  Cells lid = pocketed(half - c, stack_top + c, plug);
  lid.add(low(half + p.wall, rim + c), square(half + p.wall, rim + c + p.wall));
  add_part(model, "lid", lid.mesh());

  model.truth.steps.push_back(slide("lid", Point(0, 0, plug + boss + p.wall), true));
  std::string above = "lid";
  for (int k = p.count; k >= 1; --k) {
    const std::string name = "plate_" + std::to_string(k);
    model.truth.precedence.emplace_back(above, name);
    model.truth.steps.push_back(slide(name, Point(0, 0, rim + 2 * t - (k - 1) * (t + c)), true));
    above = name;
  }
  return model;
}

struct ClosedBoxParameters {
  double size = 100, height = 20, plate = 5, wall = 0.003, clearance = 1;
  static void describe(Schema<ClosedBoxParameters>& s) {
    s.add("size", &ClosedBoxParameters::size,
          {.unit = "mm", .min = 20, .max = 500, .doc = "Outer edge of the box along x and y."});
    s.add("height", &ClosedBoxParameters::height,
          {.unit = "mm", .min = 10, .max = 500, .doc = "Inner height of the box."});
    s.add("plate", &ClosedBoxParameters::plate, {.unit = "mm", .min = 1, .max = 8, .doc = "Thickness of the plate."});
    s.add("wall", &ClosedBoxParameters::wall,
          {.unit = "1",
           .min = 1e-5,
           .max = 0.2,
           .doc = "Thickness of all walls, divided by `size`; 0.003 is 0.03 assembly units."});
    add_clearance(s, 0.001, 1.0);
  }
};

Model closed_box(const ClosedBoxParameters& p) {
  Model model;
  model.clearance = p.clearance;
  const double wall = p.wall * p.size;
  const Point inner(p.size / 2 - wall, p.size / 2 - wall, p.height), low(-inner.x(), -inner.y(), 0);
  const Point w = Point::Constant(wall);
  add_part(model, "box", Cells().add(low - w, inner + w).cut(low, inner).mesh());
  const Point plate(0.6 * inner.x(), 0.6 * inner.y(), p.clearance + p.plate);
  add_part(model, "plate", Cells().add(Point(-plate.x(), -plate.y(), p.clearance), plate).mesh());
  return model;
}

}  // namespace

std::vector<Maker> slot_makers() {
  return {maker<LSlotParameters>("l_slot", "A slider under a roof: to the side, then up.", &l_slot),
          maker<ZigzagParameters>("zigzag", "A block in a slot of several bends.", &zigzag),
          maker<StackedBoxParameters>("stacked_box", "A box with a lid and plates stacked inside: the order matters.",
                                      &stacked_box),
          maker<ClosedBoxParameters>("closed_box", "A plate inside a closed box of thin walls: it can never leave.",
                                     &closed_box, {.solvable = false})};
}

}  // namespace dismantle::samples
