/// Three parts of which two must move simultaneously, along different paths (figure 9).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "build.h"

namespace dismantle::samples {
namespace {

using std::numbers::pi;
/// Resolution of a twisted bar.
struct TwistMesh {
  int pieces = 12;                // per side of the square
  double layer = 2.5 * pi / 180;  // turn from layer to layer, rad
};

struct InterlockParameters {
  double size = 12, turn = 180, clearance = 0.2;
  static void describe(Schema<InterlockParameters>& s) {
    s.add("size", &InterlockParameters::size,
          {.unit = "mm", .min = 8, .max = 100, .doc = "Edge of the twisted square bar."});
    s.add("turn", &InterlockParameters::turn,
          {.unit = "deg", .min = 45, .max = 360, .doc = "Rotation of the spindle that lifts the block off its bar."});
    add_clearance(s, 0.02, 0.5);
  }
};

/// Square of half edge `half`, rotated by `angle`, with every side divided into pieces.
Loop twisted_square(double half, double angle, double z) {
  Loop loop;
  const int pieces = TwistMesh{}.pieces;
  const Loop corners = rectangle(half, half, z);
  const Eigen::AngleAxisd turn(angle, Point::UnitZ());
  for (std::size_t side = 0; side < 4; ++side)
    for (int i = 0; i < pieces; ++i)
      loop.push_back(turn * (corners[side] + (corners[(side + 1) % 4] - corners[side]) * (double(i) / pieces)));
  return loop;
}

/// Adds the layers of a bar with twist `rate` (rad/mm) that is untwisted at z = start.
void twist(Loft& loft, double half, double rate, double start, double from, double to) {
  const int layers = static_cast<int>(std::ceil(std::abs(to - from) * rate / TwistMesh{}.layer));
  for (int i = 0; i <= layers; ++i) {
    const double z = from + (to - from) * i / layers;
    loft.to(twisted_square(half, rate * (z - start), z));
  }
}

/// The spindle cannot rise (its flange is under the frame's lip), cannot leave sideways (the block around it is
/// between the frame's posts) and cannot turn alone (its twisted bar is in the block's twisted hole). The block
/// can only rise, and only while the spindle turns. Once the block is off, the spindle slides out sideways.
Model interlock3(const InterlockParameters& p) {
  Model model;
  model.clearance = p.clearance;
  const double s = p.size, c = p.clearance, half = s / 2, corner = half * std::numbers::sqrt2;
  const double rate = pi / (2.5 * s), travel = p.turn * pi / 180 / rate;
  const double block_height = 0.6 * s, block_half = 1.3 * s, wall = 0.4 * s;
  const double flange = 0.95 * s, flange_height = 0.4 * s, neck = 0.45 * s;
  const double lip = flange_height + c + 0.4 * s;  // top of the lip; its underside is c above the flange
  const double start = lip + c, block_top = start + block_height, bar_top = block_top + travel;

  // From the first corner of the square on, so that the face between circle and square does not fold.
  const auto round = [](double radius, double z) {
    Loop loop = circle(radius, z, 4 * TwistMesh{}.pieces);
    std::rotate(loop.begin(), loop.begin() + TwistMesh{}.pieces / 2, loop.end());
    return loop;
  };
  Loft spindle;
  spindle.to(round(flange, 0)).to(round(flange, flange_height));
  spindle.to(round(neck, flange_height)).to(round(neck, start));
  twist(spindle, half, rate, start, start, bar_top);
  add_part(model, "spindle", spindle.capped());

  // Distance of the hole's sides: the clearance perpendicular to the helical surface, plus the deviation of the
  // flat triangles of both surfaces from it.
  const TwistMesh mesh;
  const double stray = 2 * (s / mesh.pieces) * mesh.layer / 4 + 2 * corner * (1 - std::cos(mesh.layer / 2));
  const double hole = half + 1.02 * c * std::hypot(1.0, rate * corner * 1.2) + stray;
  Loft block;
  block.to(rectangle(block_half, block_half, start)).to(rectangle(block_half, block_half, block_top));
  twist(block, hole, rate, start, block_top, start);
  add_part(model, "block", block.ring());

  const double outer = block_half + c + wall, floor = -c - wall, rim = block_top + 0.5 * s;
  Cells frame;
  frame.add(Point(-outer, -outer, floor), Point(outer, outer, rim));
  frame.cut(Point(-flange - c, -flange - c, -c), Point(outer, flange + c, flange_height + c));
  frame.cut(Point(-neck - c, -neck - c, -c), Point(outer, neck + c, lip));
  frame.cut(Point(-block_half - c, -block_half - c, lip), Point(block_half + c, block_half + c, rim));
  frame.cut(Point(0, -0.86 * s, lip), Point(outer, 0.86 * s, rim));
  add_part(model, "frame", frame.mesh());

  model.truth.base = "frame";
  model.truth.precedence.emplace_back("block", "spindle");
  const double lift = bar_top - start + 0.05 * s;
  TruthStep off;
  off.motions.push_back({"block", {Point::UnitZ(), Point::Zero(), 0.0, lift}});
  off.motions.push_back({"spindle", {Point::UnitZ(), Point::Zero(), -rate * lift, 0.0}});
  off.out = "block";
  model.truth.steps.push_back(off);
  model.truth.steps.push_back(slide("spindle", Point(outer + flange + 0.2 * s, 0, 0), true));
  return model;
}

}  // namespace

std::vector<Maker> interlock_makers() {
  return {maker<InterlockParameters>("interlock3",
                                     "A block rises while the spindle in it turns; neither moves alone (figure 9).",
                                     &interlock3, {.translation_only = false, .one_at_a_time = false})};
}

}  // namespace dismantle::samples
