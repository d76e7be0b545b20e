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
#include <unordered_map>
#include <utility>
#include <vector>

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
  Bound bound(const TriangleBvh::Node& node) const {
    const Aabb& box = node.box;
    const Eigen::Vector3d middle = turn_ * box.center() + shift_, half = size_ * box.size() / 2;
    return {middle.head<2>(), half.head<2>().norm(), middle.z() - half.z(), middle.z() + half.z()};
  }
  const TriangleBvh::Node& node(std::uint32_t id) const { return surface_.nodes()[id]; }
  /// The i-th triangle of the hierarchy's leaves.
  std::array<Eigen::Vector3d, 3> triangle(std::uint32_t i) const {
    auto corners = surface_.corners(surface_.order()[i]);
    for (Eigen::Vector3d& p : corners) p = turn_ * p + shift_;
    return corners;
  }

 private:
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

/// Some triangle meets a ring.
bool meets(const Ring& ring, const Surroundings& around) {
  std::vector<std::uint32_t> open{0};
  while (!open.empty()) {
    const std::uint32_t id = open.back();
    open.pop_back();
    const TriangleBvh::Node& node = around.node(id);
    if (!ring.may_meet(around.bound(node))) continue;
    if (node.count == 0) {
      open.push_back(node.first);
      open.push_back(id + 1);
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
      if (ring.piece(around.triangle(i))) return true;
  }
  return false;
}

/// The blocked angles of one volume that is no tube. What a range leaves open is all that its halves look at.
class Search {
 public:
  Search(const Outline& outline, const Ring& ring, const Surroundings& around, const Arcs& known, Arcs& blocked)
      : outline_(outline), ring_(ring), around_(around), known_(known), blocked_(blocked) {}

  void run() { descend(0, kTurn, kHalvings, {{}, {0}}); }

 private:
  /// What may meet the tool in a range: pieces of triangles, and boxes of the hierarchy.
  struct Open {
    std::vector<std::uint32_t> pieces, nodes;
  };

  void descend(double lo, double hi, int halvings, const Open& open) {
    if (known(lo, hi)) return;
    const double middle = (lo + hi) / 2, half = (hi - lo) / 2 * (1 + 1e-12);
    const Eigen::Matrix2d back = Eigen::Rotation2Dd(-middle).toRotationMatrix();
    Open left;
    int wide = 0, undecided = 0;
    const auto enough = [&] { return wide >= kWide || undecided >= kUndecided; };
    const auto pierces = [&](std::uint32_t k) {
      if (enough()) {
        left.pieces.push_back(k);
        return false;
      }
      const Piece& piece = pieces_[k];
      const double margin = half * std::min(piece.farthest, outline_.farthest);
      const Seen seen = look(piece, middle, back, half, margin);
      if (seen != Seen::undecided) return seen == Seen::pierced;
      left.pieces.push_back(k);
      ++undecided;
      wide += margin >= outline_.half_width;
      return false;
    };
    for (const std::uint32_t k : open.pieces)
      if (pierces(k)) return block(lo, hi);
    std::vector<std::uint32_t> nodes = open.nodes;
    while (!nodes.empty() && !enough()) {
      const std::uint32_t id = nodes.back();
      nodes.pop_back();
      const TriangleBvh::Node& node = around_.node(id);
      if (!may_meet(around_.bound(node), back, half)) continue;
      if (node.count == 0) {
        nodes.push_back(node.first);
        nodes.push_back(id + 1);
        continue;
      }
      const auto [first, last] = pieces_of(id);
      for (std::uint32_t k = first; k < last; ++k)
        if (pierces(k)) return block(lo, hi);
    }
    left.nodes = std::move(nodes);
    if (left.pieces.empty() && left.nodes.empty()) return;
    if (halvings == 0) return block(lo, hi);
    descend(lo, middle, halvings - 1, left);
    descend(middle, hi, halvings - 1, left);
  }

  Seen look(const Piece& piece, double middle, const Eigen::Matrix2d& back, double half, double margin) const {
    const double off = piece.directions.middle - outline_.directions.middle - middle;
    const double least = std::abs(off - kTurn * std::round(off / kTurn));
    if (least > piece.directions.half + outline_.directions.half + half) return Seen::clear;
    return outline_.look(turned(piece, back), margin);
  }
  bool may_meet(const Surroundings::Bound& b, const Eigen::Matrix2d& back, double half) const {
    if (!ring_.may_meet(b)) return false;
    const double margin = half * std::min(b.middle.norm() + b.reach, outline_.farthest);
    return outline_.distance_to(back * b.middle) <= b.reach + margin;
  }
  /// Range of `pieces_`: of the triangles of a leaf, cut when it is first needed.
  std::pair<std::uint32_t, std::uint32_t> pieces_of(std::uint32_t leaf) {
    const auto known = leaves_.find(leaf);
    if (known != leaves_.end()) return known->second;
    const auto first = static_cast<std::uint32_t>(pieces_.size());
    const TriangleBvh::Node& node = around_.node(leaf);
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
      if (const auto piece = ring_.piece(around_.triangle(i))) pieces_.push_back(*piece);
    return leaves_[leaf] = {first, static_cast<std::uint32_t>(pieces_.size())};
  }
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
  std::vector<Piece> pieces_;
  std::unordered_map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> leaves_;  // by node
};

/// With what is known to be blocked.
Arcs blocked_by(const Volume& v, const Surroundings& around, const Arcs& known) {
  const bool tube = v.form == Form::tube;
  const Outline outline(v);
  Ring ring{tube ? v.inner : outline.nearest, tube ? v.radius : outline.farthest, v.low, v.high};
  const double touch = kTouch * std::max(ring.farthest, v.high - v.low);
  ring.low += touch;
  ring.high -= touch;
  if (tube) return meets(ring, around) ? Arcs{{0, kTurn}} : known;
  Arcs out = known;
  Search(outline, ring, around, known, out).run();
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
