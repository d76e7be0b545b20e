/// Round parts that are larger than their bore or groove: pressed pins, screws in plain bores, seals.
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "build.h"

namespace dismantle::samples {
namespace {

using std::numbers::pi;

struct PressedPinParameters {
  double diameter = 10, length = 30, interference = 0.1;
  int segments = 64;
  static void describe(Schema<PressedPinParameters>& s) {
    s.add("diameter", &PressedPinParameters::diameter,
          {.unit = "mm", .min = 3, .max = 100, .doc = "Diameter of the pin."});
    s.add("length", &PressedPinParameters::length,
          {.unit = "mm", .min = 6, .max = 300, .doc = "Length of the pin; half of it is in the plate."});
    s.add("interference", &PressedPinParameters::interference,
          {.unit = "mm", .min = 0.05, .max = 0.2, .doc = "Diameter of the pin minus the diameter of its hole."});
    add_segments(s);
  }
};

Model pressed_pin(const PressedPinParameters& p) {
  Model model;
  const double r = p.diameter / 2, hole = r - p.interference / 2, half = 1.5 * p.diameter, top = 0.5 * p.length;
  Loft plate;
  plate.to(rectangle(half, half, 0)).to(rectangle(half, half, top));
  plate.to(circle(hole, top, p.segments)).to(circle(hole, 0, p.segments));
  add_part(model, "plate", plate.ring());
  const double bottom = -0.1 * p.length;
  add_part(model, "pin",
           Loft().to(circle(r, bottom, p.segments)).to(circle(r, bottom + p.length, p.segments)).capped());
  const Point travel(0, 0, top - bottom + 0.1 * p.length);
  model.truth.base = "plate";
  model.truth.steps.push_back(slide("pin", travel, true));
  model.truth.contacts.push_back(
      {"pin", "plate", ContactClass::uniform_interference, p.interference / 2, 0, along(travel)});
  return model;
}

enum class ScrewShape { thread, cylinder };

struct PlainBoreParameters {
  ScrewShape shape = ScrewShape::thread;
  double diameter = 6, pitch = 1, length = 15, bite = 0.15;
  int segments = 48;
  static void describe(Schema<PlainBoreParameters>& s) {
    s.add_choice("shape", &PlainBoreParameters::shape,
                 {{"thread", ScrewShape::thread, "an ISO metric thread"},
                  {"cylinder", ScrewShape::cylinder, "a cylinder of the major diameter"}},
                 "How the screw is modelled.");
    s.add("diameter", &PlainBoreParameters::diameter,
          {.unit = "mm", .min = 3, .max = 50, .doc = "Major diameter of the screw."});
    s.add("pitch", &PlainBoreParameters::pitch,
          {.unit = "mm", .min = 0.4, .max = 6, .doc = "Pitch of the thread; at most a quarter of `diameter`."});
    s.add("length", &PlainBoreParameters::length,
          {.unit = "mm", .min = 6, .max = 200, .doc = "Thickness of the plate that the screw goes through."});
    s.add("bite", &PlainBoreParameters::bite,
          {.unit = "mm",
           .min = 0.05,
           .max = 0.5,
           .doc = "Radius of the screw minus the radius of the bore; at most 0.4 of `pitch`."});
    s.add("segments", &PlainBoreParameters::segments,
          {.unit = "1", .min = 24, .max = 256, .doc = "Number of flat faces per full turn of a round surface."});
  }
};

Model plain_bore_screw(const PlainBoreParameters& p) {
  if (p.pitch > p.diameter / 4)
    throw std::invalid_argument("plain_bore_screw: pitch is more than a quarter of diameter");
  if (p.bite > 0.4 * p.pitch) throw std::invalid_argument("plain_bore_screw: bite is more than 0.4 of pitch");
  Model model;
  const double d = p.diameter, r = d / 2, sharp = p.pitch * std::numbers::sqrt3 / 2, bore = r - p.bite;
  const double head = 0.64 * d, gap = 0.1 * d, top = gap + p.length, tip = top + 1.5 * p.pitch;
  Loft screw;
  screw.to(hexagon(1.6 * d, -head)).to(hexagon(1.6 * d, 0));
  if (p.shape == ScrewShape::cylinder) {
    screw.to(circle(r, 0, p.segments)).to(circle(r, tip, p.segments));
  } else {
    ThreadProfile thread;
    thread.pitch = p.pitch;
    thread.crest_radius = r;
    thread.root_radius = r - 0.625 * sharp;
    thread.crest_flat = p.pitch / 8;
    thread.root_flat = p.pitch / 4;
    const double shank = thread.root_radius - 0.05 * sharp, start = 0.5 * gap;
    const ThreadWall wall = thread_wall(thread, start, tip, p.segments);
    screw.to(circle(shank, 0, p.segments)).to(circle(shank, start, p.segments));
    screw.strip(wall.mesh, wall.bottom, wall.top);
  }
  add_part(model, "screw", screw.capped());
  Loft plate;
  plate.to(rectangle(2 * d, 2 * d, gap)).to(rectangle(2 * d, 2 * d, top));
  plate.to(circle(bore, top, p.segments)).to(circle(bore, gap, p.segments));
  add_part(model, "plate", plate.ring());
  const Point travel(0, 0, -(tip - gap + 0.2 * d));
  model.truth.base = "plate";
  model.truth.steps.push_back(slide("screw", travel, true));
  const double facets = r * (1 - std::cos(pi / p.segments));
  model.truth.contacts.push_back({"screw", "plate", ContactClass::uniform_interference, p.bite, facets, along(travel)});
  return model;
}

struct ORingParameters {
  double diameter = 20, section = 3, squeeze = 0.2, clearance = 0.1;
  int segments = 64;
  static void describe(Schema<ORingParameters>& s) {
    s.add("diameter", &ORingParameters::diameter,
          {.unit = "mm", .min = 10, .max = 200, .doc = "Diameter of the shaft."});
    s.add("section", &ORingParameters::section,
          {.unit = "mm",
           .min = 1.5,
           .max = 10,
           .doc = "Diameter of the ring's section; at most a quarter of `diameter`."});
    s.add("squeeze", &ORingParameters::squeeze,
          {.unit = "mm",
           .min = 0.05,
           .max = 0.6,
           .doc = "How far the ring cuts into the groove's floor and into the bore; at most an eighth of `section`."});
    add_clearance(s, 0.01, 0.3);
    s.add("segments", &ORingParameters::segments,
          {.unit = "1", .min = 32, .max = 256, .doc = "Number of flat faces per full turn of a round surface."});
  }
};

Model o_ring(const ORingParameters& p) {
  if (p.section > p.diameter / 4) throw std::invalid_argument("o_ring: section is more than a quarter of diameter");
  if (p.squeeze > p.section / 8) throw std::invalid_argument("o_ring: squeeze is more than an eighth of section");
  const int sides = 24;  // of the ring's section; a multiple of four, so that its extremes are corners
  Model model;
  model.clearance = p.clearance;
  const double shaft = p.diameter / 2, bore = around(shaft + p.clearance, p.segments), w = p.section / 2;
  const double middle = bore + p.squeeze - w, floor = middle - w + p.squeeze;  // of the ring; of the groove
  const double length = 4 * p.section, z = length / 2, over = p.section, groove = 0.65 * p.section;
  const auto at = [&p](double radius, double height) { return circle(radius, height, p.segments); };
  Loft shaft_loft;
  shaft_loft.to(at(shaft, -over)).to(at(shaft, z - groove)).to(at(floor, z - groove));
  shaft_loft.to(at(floor, z + groove)).to(at(shaft, z + groove)).to(at(shaft, length + over));
  add_part(model, "shaft", shaft_loft.capped());
  const double outer = bore + 0.3 * p.diameter;
  add_part(model, "housing", Loft().to(at(bore, 0)).to(at(outer, 0)).to(at(outer, length)).to(at(bore, length)).ring());
  Loft ring;
  for (int i = 0; i < p.segments; ++i) {
    Loop section = tube_section(middle, w, 2 * pi * i / p.segments, sides);
    for (Point& point : section) point.z() += z;
    ring.to(section);
  }
  add_part(model, "ring", ring.ring());
  const Point travel(0, 0, length + 2 * over);
  const double facets = (floor + w) * (1 - std::cos(pi / p.segments)) + w * (1 - std::cos(pi / sides));
  model.truth.contacts.push_back(
      {"ring", "housing", ContactClass::uniform_interference, p.squeeze, facets, along(travel)});
  model.truth.contacts.push_back({"ring", "shaft", ContactClass::uniform_interference, p.squeeze, facets, {}});
  return model;
}

}  // namespace

std::vector<Maker> pressed_makers() {
  const SampleFacts overlap{.clean = false};
  return {
      maker<PressedPinParameters>("pressed_pin", "A pin that is a little larger than its hole.", &pressed_pin, overlap),
      maker<PlainBoreParameters>("plain_bore_screw", "A screw that cuts into the wall of a plain bore.",
                                 &plain_bore_screw, overlap),
      maker<ORingParameters>("o_ring", "A seal in the groove of a shaft, squeezed by a housing.", &o_ring,
                             {.solvable = false, .clean = false})};
}

}  // namespace dismantle::samples
