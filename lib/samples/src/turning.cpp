/// Samples that cannot be disassembled without rotation.
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "build.h"

namespace dismantle::samples {
namespace {

using std::numbers::pi;

struct BoltParameters {
  double diameter = 10, pitch = 1.5, turns = 4, clearance = 0.07;
  int segments = 64;
  static void describe(Schema<BoltParameters>& s) {
    s.add("diameter", &BoltParameters::diameter,
          {.unit = "mm", .min = 3, .max = 100, .doc = "Major diameter of the thread."});
    s.add("pitch", &BoltParameters::pitch,
          {.unit = "mm",
           .min = 0.25,
           .max = 10,
           .doc = "Pitch of the right-handed, single-start thread; at most a quarter of `diameter`."});
    s.add("turns", &BoltParameters::turns,
          {.unit = "1", .min = 0, .max = 50, .doc = "Turns until the nut begins to leave the bolt."});
    s.add("clearance", &BoltParameters::clearance,
          {.unit = "mm",
           .min = 0.001,
           .max = 0.5,
           .doc = "Distance between the flanks of bolt and nut; at most a tenth of `pitch`."});
    s.add("segments", &BoltParameters::segments,
          {.unit = "1", .min = 24, .max = 512, .doc = "Number of flat faces per full turn of a round surface."});
  }
};

Model bolt_and_nut(const BoltParameters& p) {
  if (p.pitch > p.diameter / 4) throw std::invalid_argument("bolt_and_nut: pitch is more than a quarter of diameter");
  if (p.clearance > p.pitch / 10) throw std::invalid_argument("bolt_and_nut: clearance is more than a tenth of pitch");
  Model model;
  model.clearance = p.clearance;
  const double d = p.diameter, sharp = p.pitch * std::numbers::sqrt3 / 2;  // H of ISO 68-1
  ThreadProfile external;
  external.pitch = p.pitch;
  external.crest_radius = d / 2;
  external.root_radius = d / 2 - 0.625 * sharp;
  external.crest_flat = p.pitch / 8;
  external.root_flat = p.pitch / 4;

  const double head = 0.64 * d, shank = 0.2 * d, nut_height = 0.8 * d, gap = 0.05 * d;
  const double thread_end = shank + gap + nut_height + p.turns * p.pitch;
  const ThreadWall bolt_wall = thread_wall(external, shank, thread_end, p.segments);
  Loft bolt;
  const double shank_radius = external.root_radius - 0.05 * sharp;
  bolt.to(hexagon(1.6 * d, -head)).to(hexagon(1.6 * d, 0));
  bolt.to(circle(shank_radius, 0, p.segments)).to(circle(shank_radius, shank, p.segments));
  add_part(model, "bolt", bolt.strip(bolt_wall.mesh, bolt_wall.bottom, bolt_wall.top).capped());

  // Flanks are inclined by 30 degrees, so a radial shift s separates them by s / 2. The lead angle reduces this
  // slightly, and flat faces between the points of the helix cut into the nut's bore.
  const double lead = std::atan2(p.pitch, 2 * pi * external.root_radius);
  const double shift = 2.02 * p.clearance / std::cos(lead) + 0.002 * p.pitch;
  const double nut_bottom = shank + gap, nut_top = nut_bottom + nut_height;
  const double half_gap = thread_wall(external, nut_bottom, nut_top, p.segments).half_gap;
  ThreadProfile internal = external;
  internal.crest_radius = (external.crest_radius + shift) / std::cos(half_gap);
  internal.root_radius = (external.root_radius + shift) / std::cos(half_gap);
  const ThreadWall nut_wall = thread_wall(internal, nut_bottom, nut_top, p.segments);
  Loft nut;
  nut.to(hexagon(1.6 * d, nut_bottom)).to(hexagon(1.6 * d, nut_top));
  add_part(model, "nut", nut.strip(reversed(nut_wall.mesh), nut_wall.top, nut_wall.bottom).ring());

  const double turns = p.turns + (nut_height + 0.2 * d) / p.pitch;
  model.truth.steps.push_back({{{"nut", {Point::UnitZ(), Point::Zero(), 2 * pi * turns, turns * p.pitch}}}, "nut"});
  return model;
}

struct RingParameters {
  double bend_radius = 30, diameter = 8, arc = 150, sleeve_arc = 40, clearance = 0.15;
  int segments = 32;
  static void describe(Schema<RingParameters>& s) {
    s.add("bend_radius", &RingParameters::bend_radius,
          {.unit = "mm", .min = 20, .max = 300, .doc = "Radius of the tube's centre line."});
    s.add("diameter", &RingParameters::diameter, {.unit = "mm", .min = 3, .max = 10, .doc = "Diameter of the tube."});
    s.add("arc", &RingParameters::arc, {.unit = "deg", .min = 90, .max = 150, .doc = "Angle that the tube spans."});
    s.add("sleeve_arc", &RingParameters::sleeve_arc,
          {.unit = "deg", .min = 20, .max = 60, .doc = "Angle of the tube that the ring covers."});
    add_clearance(s, 0.001, 0.5);
    add_segments(s);
  }
};

/// Adds sections from `from` to `to` (rad) at most 1.5 degrees apart.
void tube(Loft& loft, const RingParameters& p, double r, double from, double to) {
  const int pieces = static_cast<int>(std::ceil(std::abs(to - from) / (1.5 * pi / 180)));
  for (int i = 0; i <= pieces; ++i)
    loft.to(tube_section(p.bend_radius, r, from + (to - from) * i / pieces, p.segments));
}

Model ring_on_curved_tube(const RingParameters& p) {
  Model model;
  model.clearance = p.clearance;
  const double degree = pi / 180, arc = p.arc * degree, sleeve_arc = p.sleeve_arc * degree;
  const double r = p.diameter / 2;
  // Straight pieces deviate from the centre line by up to `sag`, those of the tube towards the inside of the bend.
  const double sag = p.bend_radius * (1 - std::cos(0.75 * degree));
  const double bore = around(r + p.clearance + 2.5 * sag, p.segments), outer = bore + 0.4 * r, knob = 2 * r;
  const double begin = 1.1 * p.clearance / (p.bend_radius - outer) + 0.2 * degree;  // beyond the knob's face at 0
  const double knob_arc = 0.8 * r / p.bend_radius;

  Loft tube_loft;
  tube(tube_loft, p, knob, -knob_arc, 0);
  tube(tube_loft, p, r, 0, arc);
  add_part(model, "tube", tube_loft.capped());
  Loft ring;
  tube(ring, p, outer, begin, begin + sleeve_arc);
  tube(ring, p, bore, begin + sleeve_arc, begin);
  add_part(model, "ring", ring.ring());
  model.truth.steps.push_back({{{"ring", {Point::UnitZ(), Point::Zero(), arc - begin + 2 * degree, 0.0}}}, "ring"});
  return model;
}

}  // namespace

std::vector<Maker> turning_makers() {
  return {maker<BoltParameters>("bolt_and_nut", "A hexagon bolt and nut with a true ISO metric thread.", &bolt_and_nut,
                                {.translation_only = false}),
          maker<RingParameters>("ring_on_curved_tube", "A ring that covers part of a bent tube.", &ring_on_curved_tube,
                                {.translation_only = false})};
}

}  // namespace dismantle::samples
