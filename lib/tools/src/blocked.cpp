// At which angles a tool meets a part. A turn about the axis keeps heights and distances from it. So each volume and
// each triangle is cut to their common heights, and the question is one of plane outlines. Ranges of angles are halved
// until a range is proved to be clear, or to be blocked: a point turns by no more than its distance from the axis times
// the angle.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "arcs.h"
#include "dismantle/aabb.h"
#include "frame.h"
#include "section.h"

namespace dismantle::tools {
namespace {

constexpr int kHalvings = 16;  // of a turn: 1e-4 rad
// A range is halved without a look at the other triangles after so many undecided ones: by the first number if their
// margin is wider than the outline, so that they cannot be proved to meet it.
constexpr int kWide = 4, kUndecided = 200;
constexpr double kTouch = 1e-9;  // of a tool's size: what is closer to its ends touches only

/// The triangles of an obstacle in the frame of the tool.
class Surroundings {
 public:
  Surroundings(const Frame& frame, const Obstacle& obstacle)
      : surface_(*obstacle.surface),
        turn_(frame.mm * frame.axes.transpose() * obstacle.pose.q.toRotationMatrix()),
        size_(turn_.cwiseAbs()),
        shift_(frame.inward(obstacle.pose.t)) {}

  /// A box of the hierarchy, seen along the axis.
  struct Bound {
    Eigen::Vector2d middle;
    double reach, low, high;
  };
  /// Calls visit(triangle) for the triangles of the boxes with may_meet(bound), until one returns false.
  template <class MayMeet, class Visit>
  void visit(const MayMeet& may_meet, const Visit& visit) const {
    std::array<std::uint32_t, 192> stack;
    std::size_t top = 0;
    stack[top++] = 0;
    while (top > 0) {
      const std::uint32_t id = stack[--top];
      const TriangleBvh::Node& node = surface_.nodes()[id];
      if (!may_meet(bound(node.box))) continue;
      if (node.count == 0) {
        stack[top++] = node.first;
        stack[top++] = id + 1;
        continue;
      }
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        auto corners = surface_.corners(surface_.order()[i]);
        for (Eigen::Vector3d& p : corners) p = turn_ * p + shift_;
        if (!visit(corners)) return;
      }
    }
  }

 private:
  Bound bound(const Aabb& box) const {
    const Eigen::Vector3d middle = turn_ * box.center() + shift_, half = size_ * box.size() / 2;
    return {middle.head<2>(), half.head<2>().norm(), middle.z() - half.z(), middle.z() + half.z()};
  }

  const TriangleBvh& surface_;
  Eigen::Matrix3d turn_, size_;
  Eigen::Vector3d shift_;
};

/// The region of a volume at all angles.
struct Ring {
  double nearest, farthest, low, high;
  bool may_meet(const Surroundings::Bound& b) const {
    const double r = b.middle.norm();
    return b.low < high && b.high > low && r - b.reach < farthest && r + b.reach > nearest;
  }
  std::optional<Piece> piece(const std::array<Eigen::Vector3d, 3>& triangle) const {
    auto out = piece_of(triangle, low, high);
    if (out && (out->nearest >= farthest || out->farthest <= nearest)) out.reset();
    return out;
  }
};

/// The blocked angles of one volume that is no tube.
class Search {
 public:
  Search(const Outline& outline, const Ring& ring, const Surroundings& around, const Arcs& known, Arcs& blocked)
      : outline_(outline), ring_(ring), around_(around), known_(known), blocked_(blocked) {}

  void descend(double lo, double hi, int halvings) {
    if (known(lo, hi)) return;
    const double middle = (lo + hi) / 2, half = (hi - lo) / 2 * (1 + 1e-12);
    const Eigen::Rotation2Dd back(-middle);
    bool pierced = false;
    int wide = 0, undecided = 0;
    const auto may_meet = [&](const Surroundings::Bound& b) {
      if (!ring_.may_meet(b)) return false;
      const double margin = half * std::min(b.middle.norm() + b.reach, outline_.farthest);
      return outline_.distance_to(back * b.middle) <= b.reach + margin;
    };
    around_.visit(may_meet, [&](const std::array<Eigen::Vector3d, 3>& triangle) {
      const auto piece = ring_.piece(triangle);
      if (!piece) return true;
      const double off = std::remainder(piece->directions.middle - outline_.directions.middle - middle, kTurn);
      if (std::abs(off) > piece->directions.half + outline_.directions.half + half) return true;
      const double margin = half * std::min(piece->farthest, outline_.farthest);
      if (outline_.clear(*piece, -middle, margin)) return true;
      pierced = outline_.pierced(*piece, -middle, margin);
      wide += margin >= outline_.half_width;
      return !pierced && wide < kWide && ++undecided < kUndecided;
    });
    if (!pierced && wide + undecided == 0) return;
    if (pierced || halvings == 0) return block(lo, hi);
    descend(lo, middle, halvings - 1);
    descend(middle, hi, halvings - 1);
  }

 private:
  bool known(double lo, double hi) const {
    const auto after = std::upper_bound(known_.begin(), known_.end(), std::pair{lo, kTurn});
    return after != known_.begin() && std::prev(after)->second >= hi;
  }
  void block(double lo, double hi) { blocked_.emplace_back(lo, hi); }

  const Outline& outline_;
  const Ring& ring_;
  const Surroundings& around_;
  const Arcs& known_;
  Arcs& blocked_;
};

/// With what is known to be blocked.
Arcs blocked_by(const Volume& v, const Surroundings& around, const Arcs& known) {
  const bool tube = v.form == Form::tube;
  const Outline outline(v);
  Ring ring{tube ? v.inner : outline.nearest, tube ? v.radius : outline.farthest, v.low, v.high};
  const double touch = kTouch * std::max(ring.farthest, v.high - v.low);
  ring.low += touch;
  ring.high -= touch;
  Arcs out = known;
  if (tube) {
    around.visit([&](const Surroundings::Bound& b) { return ring.may_meet(b); },
                 [&](const std::array<Eigen::Vector3d, 3>& triangle) {
                   const bool meets = ring.piece(triangle).has_value();
                   if (meets) out = {{0, kTurn}};
                   return !meets;
                 });
    return out;
  }
  Search(outline, ring, around, known, out).descend(0, kTurn, kHalvings);
  return joined(std::move(out));
}

/// A point of the volume at an angle.
Eigen::Vector3d point_of(const Volume& v, double angle) {
  const double z = (v.low + v.high) / 2;
  const Eigen::Vector2d p =
      v.form == Form::tube ? Eigen::Vector2d((v.inner + v.radius) / 2, 0) : Eigen::Vector2d((v.from + v.to) / 2);
  return {std::cos(angle) * p.x() - std::sin(angle) * p.y(), std::sin(angle) * p.x() + std::cos(angle) * p.y(), z};
}

/// A tool without a triangle in it may be inside the part. It is in one piece: all of it is inside, or nothing.
void add_buried(const std::vector<Volume>& volumes, const Frame& frame, const Obstacle& obstacle, const Aabb& box,
                Arcs& blocked) {
  const Arcs before = blocked;
  const Pose back = obstacle.pose.inverse();
  const auto buried = [&](double lo, double hi) {
    Eigen::Vector3d p;
    for (const Volume& v : volumes) {
      p = back * frame.outward(point_of(v, (lo + hi) / 2));
      if (!box.contains(p)) return false;
    }
    return obstacle.surface->inside(p);
  };
  double from = 0;
  for (std::size_t i = 0; i <= before.size(); ++i) {
    const double to = i < before.size() ? before[i].first : kTurn;
    if (to > from && buried(from, to)) blocked.emplace_back(from, to);
    if (i < before.size()) from = before[i].second;
  }
  blocked = joined(std::move(blocked));
}

}  // namespace

Arcs blocked_angles(const Use& use, const Fastener& fastener, const Obstacle& obstacle, bool hand) {
  if (obstacle.surface->nodes().empty()) return {};
  const std::vector<Volume> volumes = swept(use, fastener, hand);
  const Frame frame(use, fastener);
  const Surroundings around(frame, obstacle);
  Arcs blocked;
  for (const Volume& v : volumes) blocked = blocked_by(v, around, blocked);
  if (obstacle.closed) add_buried(volumes, frame, obstacle, obstacle.surface->nodes().front().box, blocked);
  return blocked;
}

}  // namespace dismantle::tools
