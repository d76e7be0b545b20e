/// Parts that bend in reality, or overlap in few places: clips, springs, gears that cut into each other.
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "build.h"

namespace dismantle::samples {
namespace {

using std::numbers::pi;

struct SnapFitParameters {
  double width = 6, thickness = 4, reach = 1.5, clearance = 0.1, overlap = 0.1;
  static void describe(Schema<SnapFitParameters>& s) {
    s.add("width", &SnapFitParameters::width,
          {.unit = "mm", .min = 4, .max = 40, .doc = "Edge of the hook's square arm."});
    s.add("thickness", &SnapFitParameters::thickness,
          {.unit = "mm", .min = 2, .max = 30, .doc = "Thickness of the plate that the arm goes through."});
    s.add(
        "reach", &SnapFitParameters::reach,
        {.unit = "mm",
         .min = 0.8,
         .max = 5,
         .doc = "How far the hook reaches beyond its arm: at least four times `clearance` + `overlap`, at most half of "
                "`width`."});
    add_clearance(s, 0.02, 0.2);
    s.add("overlap", &SnapFitParameters::overlap,
          {.unit = "mm", .min = 0.05, .max = 0.2, .doc = "How deep the hook cuts into the ledge that holds it."});
  }
};

/// The arm fills the hole of the plate, up to the clearance; the hook under the plate is wider than the hole.
Model snap_fit(const SnapFitParameters& p) {
  if (p.reach < 4 * (p.clearance + p.overlap))
    throw std::invalid_argument("snap_fit: reach is less than four times clearance + overlap");
  if (p.reach > p.width / 2) throw std::invalid_argument("snap_fit: reach is more than half of width");
  Model model;
  const double half = p.width / 2, c = p.clearance, hole = half + c, outer = 2 * p.width, t = p.thickness;
  Cells plate;
  plate.add(Point(-outer, -outer, 0), Point(outer, outer, t));
  plate.cut(Point(-hole, -hole, 0), Point(hole, hole, t));
  add_part(model, "plate", plate.mesh());
  Cells clip;
  clip.add(Point(-half, -half, -0.5 * p.width), Point(half, half, t + c));
  clip.add(Point(half, -half, -0.5 * p.width), Point(half + p.reach, half, p.overlap));
  clip.add(Point(-p.width, -p.width, t + c), Point(p.width, p.width, t + c + half));
  add_part(model, "clip", clip.mesh());
  model.truth.contacts.push_back({"clip", "plate", ContactClass::local_interference, p.overlap, 0, {}});
  return model;
}

struct SpringParameters {
  double wire = 2, diameter = 16, pitch = 5, turns = 4, cut = 0.1;
  static void describe(Schema<SpringParameters>& s) {
    s.add("wire", &SpringParameters::wire, {.unit = "mm", .min = 0.6, .max = 6, .doc = "Diameter of the wire."});
    s.add("diameter", &SpringParameters::diameter,
          {.unit = "mm", .min = 6, .max = 100, .doc = "Mean diameter of the coils; at least four times `wire`."});
    s.add("pitch", &SpringParameters::pitch,
          {.unit = "mm", .min = 1, .max = 30, .doc = "Rise per turn; from 1.5 times `wire` to `diameter`."});
    s.add("turns", &SpringParameters::turns, {.unit = "1", .min = 1.5, .max = 20, .doc = "Number of turns."});
    s.add("cut", &SpringParameters::cut,
          {.unit = "mm",
           .min = 0.05,
           .max = 0.3,
           .doc = "How deep the ends of the wire cut into the seats; at most a sixth of `wire`."});
  }
};

Model spring_between_seats(const SpringParameters& p) {
  if (p.diameter < 4 * p.wire)
    throw std::invalid_argument("spring_between_seats: diameter is less than four times wire");
  if (p.pitch < 1.5 * p.wire || p.pitch > p.diameter)
    throw std::invalid_argument("spring_between_seats: pitch is not between 1.5 times wire and diameter");
  if (p.cut > p.wire / 6) throw std::invalid_argument("spring_between_seats: cut is more than a sixth of wire");
  // Corners of the wire's section (a multiple of four, so that its lowest and highest point are corners), sections per
  // turn, and corners of the seats.
  const int sides = 16, per_turn = 48, seat_corners = 64;
  Model model;
  const double w = p.wire / 2, coil = p.diameter / 2, rise = p.pitch * p.turns, top = rise + 2 * (w - p.cut);
  const double seat = coil + 2 * p.wire, thick = 1.5 * p.wire;
  model.clearance = 0.9 * top;
  add_part(model, "lower_seat",
           Loft().to(circle(seat, -thick, seat_corners)).to(circle(seat, 0, seat_corners)).capped());
  const int pieces = static_cast<int>(std::ceil(per_turn * p.turns));
  Loft spring;
  for (int i = 0; i <= pieces; ++i) {
    const double share = static_cast<double>(i) / pieces;
    Loop section = tube_section(coil, w, 2 * pi * p.turns * share, sides);
    for (Point& point : section) point.z() += w - p.cut + rise * share;
    spring.to(section);
  }
  add_part(model, "spring", spring.capped());
  add_part(model, "upper_seat",
           Loft().to(circle(seat, top, seat_corners)).to(circle(seat, top + thick, seat_corners)).capped());
  const Point up(0, 0, top + thick + p.wire), down = -up;
  model.truth.base = "lower_seat";
  model.truth.steps.push_back(slide("upper_seat", up, true));
  model.truth.steps.push_back(slide("spring", up, true));
  model.truth.contacts.push_back({"spring", "lower_seat", ContactClass::local_interference, p.cut, 0, along(up)});
  model.truth.contacts.push_back({"spring", "upper_seat", ContactClass::local_interference, p.cut, 0, along(down)});
  return model;
}

struct GearParameters {
  int teeth_a = 20, teeth_b = 30;
  double module = 2, width = 8, cut = 0.2;
  static void describe(Schema<GearParameters>& s) {
    s.add("teeth_a", &GearParameters::teeth_a, {.unit = "1", .min = 18, .max = 80, .doc = "Teeth of the first gear."});
    s.add("teeth_b", &GearParameters::teeth_b, {.unit = "1", .min = 18, .max = 80, .doc = "Teeth of the second gear."});
    s.add("module", &GearParameters::module,
          {.unit = "mm", .min = 0.5, .max = 5, .doc = "Pitch diameter, divided by the number of teeth."});
    s.add("width", &GearParameters::width, {.unit = "mm", .min = 2, .max = 60, .doc = "Length of the teeth."});
    s.add("cut", &GearParameters::cut,
          {.unit = "mm",
           .min = 0.05,
           .max = 0.5,
           .doc = "Reduction of the distance between the axes; at most a sixth of `module`."});
  }
};

/// Standard pressure angle of involute teeth (ISO 53), rad.
constexpr double kPressureAngle = 20 * pi / 180;

/// Section of a spur gear with involute teeth (20 degrees) about the z axis, a tooth at angle `phase`; height z.
Loop gear_section(int teeth, double module, double phase, double z) {
  const int points = 12;  // per flank
  const double pitch_radius = module * teeth / 2, base = pitch_radius * std::cos(kPressureAngle);
  const double root = pitch_radius - 1.25 * module, tip = pitch_radius + module, foot = std::max(base, root);
  const auto involute = [base](double r) {
    const double t = std::sqrt(std::max(0.0, r * r / (base * base) - 1));
    return t - std::atan(t);
  };
  const double pitch_involute = std::tan(kPressureAngle) - kPressureAngle;
  const auto half_angle = [&](double r) { return pi / (2 * teeth) + pitch_involute - involute(r); };
  std::vector<std::pair<double, double>> flank;  // radius, angle from the middle of the tooth
  // Below the base circle the flank is slightly inclined: radial lines would have no area seen from the axis.
  if (root < base - 1e-6 * module) flank.emplace_back(root, half_angle(base) + 0.1 * (base - root) / base);
  const double from = std::sqrt(std::max(0.0, foot * foot / (base * base) - 1));
  const double to = std::sqrt(tip * tip / (base * base) - 1);
  for (int i = 0; i < points; ++i) {
    const double t = from + (to - from) * i / (points - 1), r = base * std::sqrt(1 + t * t);
    flank.emplace_back(r, half_angle(r));
  }
  Loop loop;
  const auto put = [&](double r, double angle) { loop.emplace_back(r * std::cos(angle), r * std::sin(angle), z); };
  for (int k = 0; k < teeth; ++k) {
    const double middle = phase + 2 * pi * k / teeth;
    for (const auto& [r, angle] : flank) put(r, middle - angle);
    for (auto it = flank.rbegin(); it != flank.rend(); ++it) put(it->first, middle + it->second);
  }
  return loop;
}

Model gear_pair(const GearParameters& p) {
  if (p.cut > p.module / 6) throw std::invalid_argument("gear_pair: cut is more than a sixth of module");
  Model model;
  const auto gear = [&p](int teeth, double phase) {
    return Loft()
        .to(gear_section(teeth, p.module, phase, 0))
        .to(gear_section(teeth, p.module, phase, p.width))
        .capped();
  };
  add_part(model, "gear_a", gear(p.teeth_a, 0));
  Mesh other = gear(p.teeth_b, pi + pi / p.teeth_b);  // a gap where the first gear has a tooth
  for (Point& v : other.vertices) v.x() += p.module * (p.teeth_a + p.teeth_b) / 2 - p.cut;
  add_part(model, "gear_b", std::move(other));
  const Point travel(0, 0, 1.2 * p.width);
  model.truth.base = "gear_a";
  model.truth.steps.push_back(slide("gear_b", travel, true));
  // If the axes are nearer by `cut`, involutes overlap by this along the line of action, at every tooth in contact.
  const double depth = p.cut * std::sin(kPressureAngle);
  model.truth.contacts.push_back(
      {"gear_b", "gear_a", ContactClass::local_interference, depth, 0.25 * depth + 0.002 * p.module, along(travel)});
  return model;
}

}  // namespace

std::vector<Maker> flexible_makers() {
  const SampleFacts overlap{.clean = false};
  return {maker<SnapFitParameters>("snap_fit", "A clip whose hook is behind a ledge and cuts into it.", &snap_fit,
                                   {.solvable = false, .clean = false}),
          maker<SpringParameters>("spring_between_seats", "A compression spring whose ends cut into both seats.",
                                  &spring_between_seats, overlap),
          maker<GearParameters>("gear_pair", "Two spur gears whose axes are too near: the teeth cut into each other.",
                                &gear_pair, overlap)};
}

}  // namespace dismantle::samples
