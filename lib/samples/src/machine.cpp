/// A machine with any number of parts: modules on a base plate. All parts leave by straight slides.
#include <algorithm>
#include <cmath>

#include "build.h"

namespace dismantle::samples {
namespace {

struct MachineParameters {
  int parts = 12;
  double clearance = 0.1;
  int segments = 32;
  static void describe(Schema<MachineParameters>& s) {
    s.add("parts", &MachineParameters::parts,
          {.unit = "1", .min = 4, .max = 10000, .doc = "Number of parts, the base included."});
    add_clearance(s, 0.005, 0.3);
    add_segments(s);
  }
};

/// Dimensions that all modules share, mm.
struct ModuleShape {
  double tile = 24;  // edge of a module's square on the base
  double root = 3;   // half width of its square foot
  double deep = 6;   // depth of the foot in the base
  double lift = 80;  // height that lifts any part of a module above every other part
};

enum class ModuleKind { stack, pinned, fork };

struct Module {
  ModuleKind kind = ModuleKind::stack;
  int parts = 1;
};

/// Makes one module around the origin of its tile, z = 0 at the top of the base, and moves it to its place.
class ModuleMaker {
 public:
  ModuleMaker(Model& model, const MachineParameters& p, const Point& place, int number, double outward)
      : model_(model), p_(p), c_(p.clearance), place_(place), number_(std::to_string(number)), outward_(outward) {}

  void make(const Module& m) {
    if (m.kind == ModuleKind::stack) stack(m.parts);
    if (m.kind == ModuleKind::pinned) pinned();
    if (m.kind == ModuleKind::fork) fork(m.parts);
  }

 private:
  std::string add(const std::string& name, Mesh mesh) {
    for (Point& v : mesh.vertices) v += place_;
    return add_part(model_, name, std::move(mesh));
  }
  void remove(const std::string& part, const Point& displacement) {
    model_.truth.steps.push_back(slide(part, displacement, true));
  }
  void before(const std::string& a, const std::string& b) { model_.truth.precedence.emplace_back(a, b); }

  /// A flanged shaft with washers on it; the lowest washer lies on the flange.
  void stack(int parts) {
    const int washers = parts - 1, n = p_.segments;
    const double flange = 3, r = 3, step = 4, height = flange + washers * step + 4;
    Loft shaft;
    shaft.to(rectangle(shape_.root, shape_.root, c_ - shape_.deep)).to(rectangle(shape_.root, shape_.root, c_));
    shaft.to(circle(8, c_, n)).to(circle(8, flange, n)).to(circle(r, flange, n)).to(circle(r, height, n));
    const std::string shaft_name = add("shaft_" + number_, shaft.capped());
    const double bore = around(r + c_, n);
    std::vector<std::string> names;
    for (int k = 0; k < washers; ++k) {
      const double z0 = flange + c_ + k * step, z1 = z0 + step - c_;
      Loft washer;
      washer.to(circle(bore, z0, n)).to(circle(9, z0, n)).to(circle(9, z1, n)).to(circle(bore, z1, n));
      names.push_back(add("washer_" + number_ + "_" + std::to_string(k + 1), washer.ring()));
    }
    unstack(names, shaft_name);
  }

  /// A two-pronged fork that carries bridge plates.
  void fork(int parts) {
    const int bridges = parts - 1;
    const double bar = 4, step = 4, height = bar + bridges * step + 4;
    Cells body;
    body.add(Point(-shape_.root, -shape_.root, c_ - shape_.deep), Point(shape_.root, shape_.root, c_));
    body.add(Point(-8, -shape_.root, c_), Point(8, shape_.root, bar));
    for (const double x : {-8.0, 4.0}) body.add(Point(x, -2, bar), Point(x + 4, 2, height));
    const std::string fork_name = add("fork_" + number_, body.mesh());
    std::vector<std::string> names;
    for (int k = 0; k < bridges; ++k) {
      const double z0 = bar + c_ + k * step, z1 = z0 + step - c_;
      Cells bridge;
      bridge.add(Point(-11, -5, z0), Point(11, 5, z1));
      for (const double x : {-8.0, 4.0}) bridge.cut(Point(x - c_, -2 - c_, z0), Point(x + 4 + c_, 2 + c_, z1));
      names.push_back(add("bridge_" + number_ + "_" + std::to_string(k + 1), bridge.mesh()));
    }
    unstack(names, fork_name);
  }

  /// The parts of a stack leave upwards, the top one first and the carrier last.
  void unstack(const std::vector<std::string>& names, const std::string& carrier) {
    for (std::size_t k = names.size(); k-- > 0;) {
      before(names[k], k > 0 ? names[k - 1] : carrier);
      remove(names[k], Point(0, 0, shape_.lift));
    }
    remove(carrier, Point(0, 0, shape_.lift));
  }

  /// A tower, a cap over it and a pin with a head through both. The pin leaves outwards.
  void pinned() {
    const double out = outward_;
    const auto box = [&](Cells& cells, bool solid, Point lo, Point hi) {
      if (out < 0) {  // mirrored in y
        std::swap(lo.y(), hi.y());
        lo.y() = -lo.y();
        hi.y() = -hi.y();
      }
      solid ? cells.add(lo, hi) : cells.cut(lo, hi);
    };
    const double pin = 1.5, axis = 9;  // half width and height of the pin
    Cells tower, cap, bolt;
    box(tower, true, Point(-shape_.root, -shape_.root, c_ - shape_.deep), Point(shape_.root, shape_.root, c_));
    box(tower, true, Point(-5, -5, c_), Point(5, 5, 14));
    box(tower, false, Point(-pin - c_, -5, axis - pin - c_), Point(pin + c_, 5, axis + pin + c_));
    box(cap, true, Point(-8, -8, 2), Point(8, 8, 17));
    box(cap, false, Point(-5 - c_, -5 - c_, 2), Point(5 + c_, 5 + c_, 14 + c_));
    box(cap, false, Point(-pin - c_, -8, axis - pin - c_), Point(pin + c_, 8, axis + pin + c_));
    box(bolt, true, Point(-pin, -9, axis - pin), Point(pin, 8 + c_, axis + pin));
    box(bolt, true, Point(-3, 8 + c_, axis - 3), Point(3, 10.5, axis + 3));
    const std::string tower_name = add("tower_" + number_, tower.mesh());
    const std::string cap_name = add("cap_" + number_, cap.mesh());
    const std::string pin_name = add("pin_" + number_, bolt.mesh());
    before(pin_name, cap_name);
    before(cap_name, tower_name);
    remove(pin_name, Point(0, out * 25, 0));
    remove(cap_name, Point(0, 0, shape_.lift));
    remove(tower_name, Point(0, 0, shape_.lift));
  }

  Model& model_;
  const MachineParameters& p_;
  double c_;
  Point place_;
  std::string number_;
  double outward_;
  ModuleShape shape_;
};

/// Modules with `parts` parts in total. Pinned towers are only in the first and last row, where their pins
/// can leave.
std::vector<Module> modules_for(int parts) {
  std::vector<Module> modules;
  int turn = 0;
  while (parts > 0) {
    Module m;
    if (turn % 3 == 0) m = {ModuleKind::stack, 5};
    if (turn % 3 == 1) m = {ModuleKind::pinned, 3};
    if (turn % 3 == 2) m = {ModuleKind::fork, 4};
    if (m.parts > parts) m = {ModuleKind::stack, parts};
    parts -= m.parts;
    modules.push_back(m);
    ++turn;
  }
  return modules;
}

Model machine(const MachineParameters& p) {
  Model model;
  model.clearance = p.clearance;
  std::vector<Module> modules = modules_for(p.parts - 1);
  const int columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(modules.size()))));
  const int rows = (static_cast<int>(modules.size()) + columns - 1) / columns;
  const auto row_of = [columns](std::size_t i) { return static_cast<int>(i) / columns; };
  // A pinned tower of an inner row is swapped with another module of an outer row, or becomes a stack.
  for (std::size_t i = 0; i < modules.size(); ++i) {
    if (modules[i].kind != ModuleKind::pinned || row_of(i) == 0 || row_of(i) == rows - 1) continue;
    const auto outer = std::find_if(modules.begin(), modules.end(), [&](const Module& m) {
      const int row = row_of(static_cast<std::size_t>(&m - modules.data()));
      return m.kind != ModuleKind::pinned && (row == 0 || row == rows - 1);
    });
    if (outer != modules.end())
      std::swap(modules[i], *outer);
    else
      modules[i].kind = ModuleKind::stack;
  }

  const ModuleShape shape;
  const Point size(columns * shape.tile, rows * shape.tile, 0);
  Cells base;
  base.add(Point(0, 0, -shape.deep - 6), size);
  const double half = shape.root + p.clearance;
  const auto place = [&](std::size_t i) {
    return Point((static_cast<int>(i) % columns + 0.5) * shape.tile, (row_of(i) + 0.5) * shape.tile, 0);
  };
  for (std::size_t i = 0; i < modules.size(); ++i)
    base.cut(place(i) + Point(-half, -half, -shape.deep), place(i) + Point(half, half, 0));
  model.truth.base = add_part(model, "base", base.mesh());
  for (std::size_t i = 0; i < modules.size(); ++i)
    ModuleMaker(model, p, place(i), static_cast<int>(i) + 1, row_of(i) == 0 ? -1.0 : 1.0).make(modules[i]);
  return model;
}

}  // namespace

std::vector<Maker> machine_makers() {
  return {maker<MachineParameters>("machine", "A base plate with shafts, washers, forks, bridges and pinned towers.",
                                   &machine)};
}

}  // namespace dismantle::samples
