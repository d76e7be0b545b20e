#include "dismantle/tools/two_tools.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "arcs.h"
#include "frame.h"
#include "plane.h"

namespace dismantle::tools {
namespace {

using Eigen::Vector2d;

constexpr double kDegree = kTurn / 360;

/// All points within `radius` of a point, a segment or a rectangle, between two heights.
struct Solid {
  std::array<Vector2d, 4> corners;
  std::size_t count = 0;
  double radius = 0, low = 0, high = 0;
  double reach() const {
    double out = 0;
    for (std::size_t i = 0; i < count; ++i) out = std::max(out, corners[i].norm());
    return out + radius;
  }
};

Solid solid_of(const Volume& v) {
  Solid s;
  s.low = v.low;
  s.high = v.high;
  s.radius = v.form == Form::box ? 0 : v.radius;
  switch (v.form) {
    case Form::tube:
      s.corners[0] = Vector2d::Zero();
      s.count = 1;
      break;
    case Form::obround:
      s.corners[0] = v.from;
      s.corners[1] = v.to;
      s.count = 2;
      break;
    case Form::box:
      s.corners = {v.from, Vector2d(v.to.x(), v.from.y()), v.to, Vector2d(v.from.x(), v.to.y())};
      s.count = 4;
      break;
  }
  return s;
}

std::vector<Solid> solids_of(const ToolOn& tool, bool hand) {
  std::vector<Solid> out;
  for (const Volume& v : swept(tool.use, tool.fastener, hand)) out.push_back(solid_of(v));
  return out;
}

Solid turned(Solid s, double angle) {
  const Eigen::Rotation2Dd turn(angle);
  for (std::size_t i = 0; i < s.count; ++i) s.corners[i] = turn * s.corners[i];
  return s;
}

bool contains(const Solid& s, const Vector2d& p) {
  if (s.count < 4) return false;
  bool left = true, right = true;
  for (std::size_t i = 0; i < 4; ++i) {
    const double side = cross(s.corners[(i + 1) % 4] - s.corners[i], p - s.corners[i]);
    left = left && side >= 0;
    right = right && side <= 0;
  }
  return left || right;
}

/// Across the axis, of what is within the radii of two cores.
double gap(const Solid& a, const Solid& b) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < a.count; ++i) {
    const Vector2d &p = a.corners[i], &p2 = a.corners[(i + 1) % a.count];
    if (contains(b, p)) return -1;
    for (std::size_t k = 0; k < b.count; ++k) {
      const Vector2d &q = b.corners[k], &q2 = b.corners[(k + 1) % b.count];
      if (contains(a, q)) return -1;
      const double one = cross(p2 - p, q - p), two = cross(p2 - p, q2 - p), three = cross(q2 - q, p - q),
                   four = cross(q2 - q, p2 - q);
      if (one * two < 0 && three * four < 0) return -1;
      least = std::min({least, point_to_segment(p, q, q2), point_to_segment(q, p, p2)});
    }
  }
  return least - a.radius - b.radius;
}

class Both {
 public:
  Both(const ToolOn& turning, const ToolOn& holding, bool hand)
      : turning_(turning),
        holding_(holding),
        frame_(turning.use, turning.fastener),
        other_(holding.use, holding.fastener),
        moving_(solids_of(turning, hand)),
        still_(solids_of(holding, hand)) {}

  std::optional<BothAccess> found() {
    BothAccess out{room_for(turning_.use, turning_.fastener, turning_.blocked),
                   room_for(holding_.use, holding_.fastener, holding_.blocked)};
    if (!out.turning.reaches() || !out.holding.reaches()) return std::nullopt;
    const std::vector<double> starts = free_angles(turning_, out.turning.start);
    for (const double hold : free_angles(holding_, out.holding.start)) {
      const std::vector<Solid> placed = placed_at(hold);
      for (const double start : starts) {
        if (!clear(start, placed)) continue;
        place(turning_, start, out.turning);
        place(holding_, hold, out.holding);
        return out;
      }
    }
    return std::nullopt;
  }

 private:
  /// `first`, then all at equal distances that are not blocked.
  static std::vector<double> free_angles(const ToolOn& tool, double first) {
    Arcs all;
    for (const Arcs* arcs : tool.blocked) all.insert(all.end(), arcs->begin(), arcs->end());
    all = joined(std::move(all));
    const auto blocked = [&](double from) {
      const double to = from + tool.use.swing;
      return std::any_of(all.begin(), all.end(), [&](const auto& arc) {
        return (arc.first <= to && from <= arc.second) || (arc.first + kTurn <= to && from <= arc.second + kTurn);
      });
    };
    std::vector<double> out{first};
    for (int k = 0; k < 36; ++k)
      if (!blocked(10 * k * kDegree)) out.push_back(10 * k * kDegree);
    return out;
  }

  static void place(const ToolOn& tool, double start, Access& access) {
    const Frame frame(tool.use, tool.fastener);
    const double middle = start + tool.use.swing / 2;
    access.start = start;
    access.handle = std::cos(middle) * frame.axes.col(0) + std::sin(middle) * frame.axes.col(1);
  }

  /// The tool that holds, in the frame of the one that turns.
  std::vector<Solid> placed_at(double angle) const {
    std::vector<Solid> out;
    for (const Solid& s : still_) {
      Solid t = turned(s, angle);
      const auto here = [&](const Vector2d& p, double z) -> Eigen::Vector3d {
        return frame_.inward(other_.outward({p.x(), p.y(), z}));
      };
      const double one = here(Vector2d::Zero(), s.low).z(), two = here(Vector2d::Zero(), s.high).z();
      t.low = std::min(one, two);
      t.high = std::max(one, two);
      for (std::size_t i = 0; i < t.count; ++i) t.corners[i] = here(t.corners[i], s.low).head<2>();
      out.push_back(t);
    }
    return out;
  }

  /// During the whole swing: at angles a degree apart, with the way between them to spare.
  bool clear(double start, const std::vector<Solid>& placed) const {
    const int steps = std::max(1, static_cast<int>(std::ceil(turning_.use.swing / kDegree)));
    const double step = turning_.use.swing / steps;
    for (const Solid& s : moving_) {
      const double spare = s.reach() * step / 2;
      for (const Solid& other : placed) {
        if (s.low >= other.high || other.low >= s.high) continue;
        for (int k = 0; k <= steps; ++k)
          if (gap(turned(s, start + k * step), other) <= spare) return false;
      }
    }
    return true;
  }

  const ToolOn &turning_, &holding_;
  Frame frame_, other_;
  std::vector<Solid> moving_, still_;
};

}  // namespace

std::optional<BothAccess> room_for_both(const ToolOn& turning, const ToolOn& holding, bool hand) {
  return Both(turning, holding, hand).found();
}

}  // namespace dismantle::tools
