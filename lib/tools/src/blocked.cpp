// At which angles a tool meets a part. A turn about the axis keeps heights and distances from it. So each volume and
// each triangle is cut to their common heights, and the question is one of plane outlines. Ranges of angles are halved
// until a range is proved to be clear, or to be blocked: a point turns by no more than its distance from the axis times
// the angle.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "arcs.h"
#include "dismantle/aabb.h"
#include "frame.h"
#include "section.h"

namespace dismantle::tools {
namespace {

constexpr int kGrid = 16;        // ranges to begin with
constexpr int kHalvings = 12;    // of each of them: 1e-4 rad
constexpr double kTouch = 1e-9;  // of a tool's size: what is closer to its ends touches only

class Search {
 public:
  Search(const Outline& outline, const std::vector<Piece>& pieces, Arcs& blocked)
      : outline_(outline), pieces_(pieces), blocked_(blocked) {}

  void run() {
    std::vector<std::uint32_t> all(pieces_.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint32_t>(i);
    for (int k = 0; k < kGrid; ++k) descend(kTurn * k / kGrid, kTurn * (k + 1) / kGrid, kHalvings, all);
  }

 private:
  void descend(double lo, double hi, int halvings, const std::vector<std::uint32_t>& list) {
    const double middle = (lo + hi) / 2, half = (hi - lo) / 2;
    std::vector<std::uint32_t> left;
    for (const std::uint32_t id : list) {
      const Piece& piece = pieces_[id];
      const double off = std::remainder(piece.directions.middle - outline_.directions.middle - middle, kTurn);
      if (std::abs(off) > piece.directions.half + outline_.directions.half + half) continue;
      const double margin = half * std::min(piece.farthest, outline_.farthest) * (1 + 1e-12);
      if (outline_.clear(piece, -middle, margin)) continue;
      if (outline_.pierced(piece, -middle, margin)) return block(lo, hi);
      left.push_back(id);
    }
    if (left.empty()) return;
    if (halvings == 0) return block(lo, hi);
    descend(lo, middle, halvings - 1, left);
    descend(middle, hi, halvings - 1, left);
  }
  void block(double lo, double hi) {
    if (!blocked_.empty() && blocked_.back().second == lo)
      blocked_.back().second = hi;
    else
      blocked_.emplace_back(lo, hi);
  }

  const Outline& outline_;
  const std::vector<Piece>& pieces_;
  Arcs& blocked_;
};

/// All angles, or the blocked ones of one volume.
void add_blocked(const Volume& v, const std::vector<std::array<Eigen::Vector3d, 3>>& triangles, double size,
                 Arcs& blocked) {
  const double touch = kTouch * size;
  std::vector<Piece> pieces;
  const bool tube = v.form == Form::tube;
  const Outline outline(v);
  const double nearest = tube ? v.inner : outline.nearest, farthest = tube ? v.radius : outline.farthest;
  for (const auto& triangle : triangles) {
    const auto piece = piece_of(triangle, v.low + touch, v.high - touch);
    if (!piece || piece->nearest >= farthest || piece->farthest <= nearest) continue;
    if (tube) {
      blocked = {{0, kTurn}};
      return;
    }
    pieces.push_back(*piece);
  }
  if (!pieces.empty()) Search(outline, pieces, blocked).run();
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
  const TriangleBvh& surface = *obstacle.surface;
  if (surface.nodes().empty()) return {};
  const std::vector<Volume> volumes = swept(use, fastener, hand);
  const Frame frame(use, fastener);
  double radius = 0, low = volumes.front().low, high = volumes.front().high;
  for (const Volume& v : volumes) {
    radius = std::max(radius, v.form == Form::tube ? v.radius : Outline(v).farthest);
    low = std::min(low, v.low);
    high = std::max(high, v.high);
  }
  // The cylinder around everything, in the frame of the part.
  const Pose back = obstacle.pose.inverse();
  Aabb around;
  const Eigen::Vector3d axis = back.q * fastener.axis;
  const Eigen::Vector3d disc = radius / frame.mm * (1 - axis.array().square()).max(0).sqrt().matrix();
  for (const double z : {low, high})
    for (const double sign : {1.0, -1.0}) around.extend(back * frame.outward({0, 0, z}) + sign * disc);
  std::vector<std::array<Eigen::Vector3d, 3>> triangles;
  surface.overlapping(around, [&](std::uint32_t t) {
    auto& corners = triangles.emplace_back(surface.corners(t));
    for (Eigen::Vector3d& p : corners) p = frame.inward(obstacle.pose * p);
  });
  const double size = std::max(radius, high - low);
  Arcs blocked;
  for (const Volume& v : volumes) {
    Arcs of_volume;
    add_blocked(v, triangles, size, of_volume);
    blocked.insert(blocked.end(), of_volume.begin(), of_volume.end());
  }
  blocked = joined(std::move(blocked));
  const Aabb& box = surface.nodes().front().box;
  if (obstacle.closed && box.overlaps(around)) add_buried(volumes, frame, obstacle, box, blocked);
  return blocked;
}

}  // namespace dismantle::tools
