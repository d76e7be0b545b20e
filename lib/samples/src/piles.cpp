/// Piles of blocks that touch: their parts come apart by slides, and their statics have closed forms.
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "build.h"

namespace dismantle::samples {
namespace {

using std::numbers::pi;

/// `a` rests on, or lies against, `b`; sliding `a` along `displacement` parts them.
void touch(Model& model, const std::string& a, const std::string& b, const Point& displacement) {
  model.truth.contacts.push_back({a, b, ContactClass::kissing, 0, 0, along(displacement)});
}

/// Removes the parts from the last that was added to the second one, each along its way.
void take_off(Model& model, const std::vector<Point>& displacements) {
  model.truth.base = model.parts.front().name;
  for (std::size_t k = model.parts.size(); k-- > 1;)
    model.truth.steps.push_back(slide(model.parts[k].name, displacements[k], true));
}

struct StackParameters {
  int blocks = 4;
  double width = 20, height = 10, shift = 0;
  static void describe(Schema<StackParameters>& s) {
    s.add("blocks", &StackParameters::blocks, {.unit = "1", .min = 2, .max = 24, .doc = "Number of blocks."});
    s.add("width", &StackParameters::width,
          {.unit = "mm", .min = 1, .max = 200, .doc = "Edge of a block along x and y."});
    s.add("height", &StackParameters::height, {.unit = "mm", .min = 1, .max = 200, .doc = "Height of a block."});
    s.add("shift", &StackParameters::shift,
          {.unit = "1",
           .min = 0,
           .max = 0.9,
           .doc = "Overhang of the k-th block from the top over the one below, as a share of `width` / (2 k). Below 1 "
                  "the stack stands."});
  }
};

/// The overhang of n blocks is shift * width / 2 * (1 + 1/2 + ... + 1/(n-1)).
Model stack(const StackParameters& p) {
  Model model;
  model.clearance = 0.9 * p.height;
  double x = 0;
  std::vector<Point> displacements;
  for (int k = 0; k < p.blocks; ++k) {
    const std::string name =
        add_part(model, "block" + std::to_string(k + 1),
                 Cells().add(Point(x, 0, k * p.height), Point(x + p.width, p.width, (k + 1) * p.height)).mesh());
    displacements.emplace_back(0, 0, 1.2 * p.height);
    if (k > 0) touch(model, name, model.parts[static_cast<std::size_t>(k) - 1].name, displacements.back());
    x += p.shift * p.width / 2 / std::max(1, p.blocks - 1 - k);
  }
  take_off(model, displacements);
  return model;
}

struct TableParameters {
  double size = 60, height = 40, leg = 6, top = 4;
  static void describe(Schema<TableParameters>& s) {
    s.add("size", &TableParameters::size, {.unit = "mm", .min = 20, .max = 500, .doc = "Edge of the top."});
    s.add("height", &TableParameters::height, {.unit = "mm", .min = 5, .max = 500, .doc = "Length of a leg."});
    s.add("leg", &TableParameters::leg, {.unit = "mm", .min = 1, .max = 9, .doc = "Edge of a leg."});
    s.add("top", &TableParameters::top, {.unit = "mm", .min = 1, .max = 50, .doc = "Thickness of the top."});
  }
};

Model loose_table(const TableParameters& p) {
  Model model;
  model.clearance = 0.9 * (p.size - 2 * p.leg);
  const double far = p.size - p.leg;
  std::vector<Point> displacements{Point::Zero()};
  for (int k = 0; k < 4; ++k) {
    const Point at(k % 2 == 0 ? 0 : far, k < 2 ? 0 : far, 0);
    add_part(model, "leg" + std::to_string(k + 1), Cells().add(at, at + Point(p.leg, p.leg, p.height)).mesh());
    if (k > 0) displacements.emplace_back(0, 0, 1.2 * p.height);
  }
  const Point out(0, 0, 1.2 * p.top);
  const std::string top =
      add_part(model, "top", Cells().add(Point(0, 0, p.height), Point(p.size, p.size, p.height + p.top)).mesh());
  for (int k = 0; k < 4; ++k) touch(model, top, "leg" + std::to_string(k + 1), out);
  displacements.push_back(out);
  take_off(model, displacements);
  return model;
}

struct WedgedParameters {
  double size = 20, wall = 10, height = 30;
  static void describe(Schema<WedgedParameters>& s) {
    s.add("size", &WedgedParameters::size, {.unit = "mm", .min = 5, .max = 200, .doc = "Edge of the block."});
    s.add("wall", &WedgedParameters::wall, {.unit = "mm", .min = 2, .max = 100, .doc = "Thickness of a wall."});
    s.add("height", &WedgedParameters::height,
          {.unit = "mm", .min = 1, .max = 200, .doc = "Height of the block above the floor."});
  }
};

/// Friction could carry the block, but nothing presses it.
Model wedged_block(const WedgedParameters& p) {
  Model model;
  model.clearance = p.height;
  const double top = p.height + p.size;
  Cells channel;
  channel.add(Point(-p.wall, 0, -p.wall), Point(p.size + p.wall, p.size, top))
      .cut(Point(0, 0, 0), Point(p.size, p.size, top));
  add_part(model, "channel", channel.mesh());
  const std::string block =
      add_part(model, "block", Cells().add(Point(0, 0, p.height), Point(p.size, p.size, top)).mesh());
  const Point out(0, 0, 1.2 * p.size);
  touch(model, block, "channel", out);
  take_off(model, {Point::Zero(), out});
  return model;
}

/// The part of a spherical or cylindrical shell between angles; corners in the order of Loft. `at`: (angle, turn,
/// radius) to a point.
template <class At>
Mesh voussoir(double from, double to, double left, double right, double inner, double outer, const At& at) {
  const auto face = [&](double turn) {
    return Loop{at(from, turn, inner), at(to, turn, inner), at(to, turn, outer), at(from, turn, outer)};
  };
  return Loft().to(face(right)).to(face(left)).capped();
}

struct ArchParameters {
  int voussoirs = 9;
  double radius = 100, thickness = 25, depth = 30;
  static void describe(Schema<ArchParameters>& s) {
    s.add("voussoirs", &ArchParameters::voussoirs,
          {.unit = "1", .min = 3, .max = 25, .doc = "Number of blocks of the arch."});
    s.add("radius", &ArchParameters::radius,
          {.unit = "mm", .min = 10, .max = 1000, .doc = "Radius of the middle of the arch."});
    s.add("thickness", &ArchParameters::thickness,
          {.unit = "mm",
           .min = 0.5,
           .max = 300,
           .doc = "Thickness; the half circle stands if it is more than about 0.108 of `radius`."});
    s.add("depth", &ArchParameters::depth, {.unit = "mm", .min = 1, .max = 500, .doc = "Depth along y."});
  }
};

Model arch(const ArchParameters& p) {
  if (p.thickness > 0.5 * p.radius) throw std::invalid_argument("arch: thickness is more than half of radius");
  Model model;
  const double inner = p.radius - p.thickness / 2, outer = p.radius + p.thickness / 2;
  const auto at = [](double angle, double y, double r) { return Point(r * std::cos(angle), y, r * std::sin(angle)); };
  add_part(model, "ground", Cells().add(Point(-1.2 * outer, 0, -p.thickness), Point(1.2 * outer, p.depth, 0)).mesh());
  std::vector<Point> displacements{Point::Zero()};
  const double step = pi / p.voussoirs;
  model.clearance = 0.9 * inner * std::sin(step);  // of the second voussoir above the ground
  for (int k = 0; k < p.voussoirs; ++k) {
    const std::string name = add_part(model, "voussoir" + std::to_string(k + 1),
                                      voussoir(k * step, (k + 1) * step, p.depth, 0, inner, outer, at));
    // Sideways: the faces between the blocks, and the ground, lie along y.
    displacements.emplace_back(0, -1.2 * p.depth, 0);
    if (k > 0) touch(model, name, model.parts[static_cast<std::size_t>(k)].name, displacements.back());
    if (k == 0 || k == p.voussoirs - 1) touch(model, name, "ground", displacements.back());
  }
  take_off(model, displacements);
  return model;
}

struct DomeParameters {
  int rings = 2, segments = 6;
  double radius = 100, thickness = 20;
  static void describe(Schema<DomeParameters>& s) {
    s.add("rings", &DomeParameters::rings, {.unit = "1", .min = 1, .max = 12, .doc = "Number of rings below the cap."});
    s.add("segments", &DomeParameters::segments,
          {.unit = "1", .min = 5, .max = 24, .doc = "Number of blocks of a ring."});
    s.add("radius", &DomeParameters::radius,
          {.unit = "mm", .min = 10, .max = 1000, .doc = "Radius of the middle of the shell."});
    s.add("thickness", &DomeParameters::thickness,
          {.unit = "mm", .min = 1, .max = 500, .doc = "Thickness; at most half of `radius`."});
  }
};

/// All joints lie in planes through the centre: each block slides outwards, whatever else is there.
Model dome(const DomeParameters& p) {
  if (p.thickness > 0.5 * p.radius) throw std::invalid_argument("dome: thickness is more than half of radius");
  Model model;
  const double inner = p.radius - p.thickness / 2, outer = p.radius + p.thickness / 2;
  const auto at = [](double angle, double turn, double r) {
    return Point(r * std::cos(angle) * std::cos(turn), r * std::cos(angle) * std::sin(turn), r * std::sin(angle));
  };
  const double far = 1.2 * outer, rise = pi / 2 / (p.rings + 0.5), turn = 2 * pi / p.segments;
  add_part(model, "ground", Cells().add(Point(-far, -far, -p.thickness), Point(far, far, 0)).mesh());
  std::vector<Point> displacements{Point::Zero()};
  // The gap across a block: of its height, or of its width at the cap.
  model.clearance =
      0.9 * inner * std::cos(turn / 2) * std::min(std::sin(rise), 2 * std::cos(p.rings * rise) * std::sin(turn / 2));
  const auto block = [](int ring, int k) { return "block" + std::to_string(ring + 1) + "_" + std::to_string(k + 1); };
  for (int ring = 0; ring < p.rings; ++ring)
    for (int k = 0; k < p.segments; ++k) {
      const double from = ring * rise, left = k * turn;
      const std::string name =
          add_part(model, block(ring, k), voussoir(from, from + rise, left + turn, left, inner, outer, at));
      displacements.push_back(far * at(from + rise / 2, left + turn / 2, 1));
      if (ring == 0) touch(model, name, "ground", displacements.back());
      if (k > 0) touch(model, name, block(ring, k - 1), displacements.back());
      if (k == p.segments - 1) touch(model, name, block(ring, 0), displacements.back());
      for (int side = ring == 0 ? 2 : -1; side < 2; ++side)  // below, and across the corners
        touch(model, name, block(ring - 1, (k + side + p.segments) % p.segments), displacements.back());
    }
  Loop low, high;
  for (int k = 0; k < p.segments; ++k) {
    low.push_back(at(p.rings * rise, k * turn, inner));
    high.push_back(at(p.rings * rise, k * turn, outer));
  }
  const std::string cap = add_part(model, "cap", Loft().to(low).to(high).capped());
  displacements.emplace_back(0, 0, far);
  for (int k = 0; k < p.segments; ++k) touch(model, cap, block(p.rings - 1, k), displacements.back());
  take_off(model, displacements);
  return model;
}

}  // namespace

std::vector<Maker> pile_makers() {
  const SampleFacts touching{.clean = false};
  return {
      maker<StackParameters>("stack", "Blocks on each other, in line or leaning out.", &stack, touching),
      maker<TableParameters>("loose_table", "A top that lies on four legs.", &loose_table, touching),
      maker<WedgedParameters>("wedged_block", "A block between two walls, above the floor.", &wedged_block, touching),
      maker<ArchParameters>("arch", "A half circle of wedges on the ground.", &arch, touching),
      maker<DomeParameters>("dome", "Rings of wedges and a cap on the ground.", &dome, touching)};
}

}  // namespace dismantle::samples
