/// Cylindrical and prismatic fits: one part slides along one line.
#include <cmath>
#include <numbers>

#include "build.h"

namespace dismantle::samples {
namespace {

enum class PegShape { round, square };

struct PegParameters {
  PegShape shape = PegShape::round;
  double size = 20, length = 40, clearance = 0.1;
  bool blind = true;
  int segments = 64;
  static void describe(Schema<PegParameters>& s) {
    s.add_choice("shape", &PegParameters::shape,
                 {{"round", PegShape::round, "cylinder"}, {"square", PegShape::square, "square prism"}},
                 "Cross-section of peg and hole.");
    s.add("size", &PegParameters::size, {.unit = "mm", .min = 5, .max = 500, .doc = "Diameter or edge of the peg."});
    s.add("length", &PegParameters::length, {.unit = "mm", .min = 5, .max = 500, .doc = "Length of the peg."});
    add_clearance(s, 0.001, 0.5);
    s.add("blind", &PegParameters::blind, {.doc = "Blind hole; otherwise a through hole."});
    add_segments(s);
  }
};

Model peg_in_hole(const PegParameters& p) {
  Model model;
  model.clearance = p.clearance;
  const double r = p.size / 2, hole = r + p.clearance, half = p.size, top = 0.75 * p.length;
  const double peg_bottom = p.blind ? 0.0 : -0.125 * p.length;
  const bool round = p.shape == PegShape::round;
  const auto section = [&](double radius, double z) {
    return round ? circle(radius, z, p.segments) : rectangle(radius, radius, z);
  };
  const double hole_radius = round ? around(hole, p.segments) : hole;
  Loft block;
  if (p.blind) {
    block.to(rectangle(half, half, -p.clearance - 0.25 * p.size)).to(rectangle(half, half, top));
    block.to(section(hole_radius, top)).to(section(hole_radius, -p.clearance));
  } else {
    block.to(rectangle(half, half, 0)).to(rectangle(half, half, top));
    block.to(section(hole_radius, top)).to(section(hole_radius, 0));
  }
  add_part(model, "block", p.blind ? block.capped() : block.ring());
  add_part(model, "peg", Loft().to(section(r, peg_bottom)).to(section(r, peg_bottom + p.length)).capped());
  model.truth.steps.push_back(slide("peg", Point(0, 0, top - peg_bottom + 0.1 * p.length), true));
  return model;
}

struct SleeveParameters {
  double diameter = 10, ratio = 10, clearance = 0.02;
  int segments = 48;
  static void describe(Schema<SleeveParameters>& s) {
    s.add("diameter", &SleeveParameters::diameter,
          {.unit = "mm", .min = 2, .max = 200, .doc = "Diameter of the shaft."});
    s.add("ratio", &SleeveParameters::ratio,
          {.unit = "1", .min = 0.5, .max = 50, .doc = "Length of the sleeve, divided by the diameter of the shaft."});
    add_clearance(s, 0.0001, 0.5);
    add_segments(s);
  }
};

Model long_sleeve(const SleeveParameters& p) {
  Model model;
  model.clearance = p.clearance;
  const double r = p.diameter / 2, length = p.ratio * p.diameter, over = 0.2 * p.diameter;
  const double bore = around(r + p.clearance, p.segments), outer = bore + 0.2 * p.diameter;
  const auto at = [&p](double radius, double z) { return circle(radius, z, p.segments); };
  add_part(model, "sleeve", Loft().to(at(bore, 0)).to(at(outer, 0)).to(at(outer, length)).to(at(bore, length)).ring());
  add_part(model, "shaft", Loft().to(at(r, -over)).to(at(r, length + over)).capped());
  model.truth.steps.push_back(slide("shaft", Point(0, 0, length + 2 * over), true));
  return model;
}

struct WasherParameters {
  double diameter = 10, length = 40, thickness = 3, tilt = 35, azimuth = 20, clearance = 0.1;
  int segments = 48;
  static void describe(Schema<WasherParameters>& s) {
    s.add("diameter", &WasherParameters::diameter,
          {.unit = "mm", .min = 4, .max = 200, .doc = "Diameter of the shaft."});
    s.add("length", &WasherParameters::length,
          {.unit = "mm", .min = 10, .max = 500, .doc = "Length of the shaft above its foot."});
    s.add("thickness", &WasherParameters::thickness,
          {.unit = "mm", .min = 0.5, .max = 5, .doc = "Thickness of the washer."});
    s.add("tilt", &WasherParameters::tilt,
          {.unit = "deg", .min = 0, .max = 90, .doc = "Angle between the shaft and the z axis."});
    s.add("azimuth", &WasherParameters::azimuth,
          {.unit = "deg", .min = -180, .max = 180, .doc = "Direction in the xy plane towards which the shaft leans."});
    add_clearance(s, 0.001, 0.5);
    add_segments(s);
  }
};

Model inclined_washer(const WasherParameters& p) {
  Model model;
  model.clearance = p.clearance;
  const double r = p.diameter / 2, foot = 1.3 * p.diameter, bottom = -0.4 * p.diameter;
  const double bore = around(r + p.clearance, p.segments), outer = around(p.diameter, p.segments);
  const double z0 = p.clearance, z1 = p.clearance + p.thickness;
  const auto at = [&p](double radius, double z) { return circle(radius, z, p.segments); };
  Mesh shaft =
      Loft().to(rectangle(foot, foot, bottom)).to(rectangle(foot, foot, 0)).to(at(r, 0)).to(at(r, p.length)).capped();
  Mesh washer = Loft().to(at(bore, z0)).to(at(outer, z0)).to(at(outer, z1)).to(at(bore, z1)).ring();
  const double degree = std::numbers::pi / 180;
  const Eigen::Quaterniond lean(Eigen::AngleAxisd(p.azimuth * degree, Point::UnitZ()) *
                                Eigen::AngleAxisd(p.tilt * degree, Point::UnitY()));
  for (Mesh* mesh : {&shaft, &washer})
    for (Point& v : mesh->vertices) v = lean * v;
  add_part(model, "shaft", std::move(shaft));
  add_part(model, "washer", std::move(washer));
  model.truth.steps.push_back(slide("washer", lean * Point(0, 0, p.length + 0.1 * p.diameter), true));
  return model;
}

}  // namespace

std::vector<Maker> fit_makers() {
  return {maker<PegParameters>("peg_in_hole", "A round or square peg in a hole.", &peg_in_hole),
          maker<WasherParameters>("inclined_washer", "A washer on a shaft that leans away from every axis (figure 2).",
                                  &inclined_washer),
          maker<SleeveParameters>("long_sleeve", "A tight sleeve on a long cylinder (figure 6).", &long_sleeve)};
}

}  // namespace dismantle::samples
