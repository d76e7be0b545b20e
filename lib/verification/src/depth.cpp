// Penetration depth of two placed meshes by branch and bound over triangles. A patch is settled when a displacement
// rule (patch.h) or the Lipschitz bound shows that it has nothing deeper than the deepest point found.
#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "depth_body.h"
#include "dismantle/geometry/numerics.h"
#include "dismantle/geometry/patch.h"
#include "dismantle/geometry/solid.h"
#include "dismantle/geometry/starts_off.h"
#include "dismantle/geometry/walls.h"
#include "dismantle/verification/interruptible_depth.h"
#include "dismantle/verification/verifier.h"
#include "geometry_names.h"

namespace dismantle {

DepthBody::DepthBody(const Mesh& mesh, const geometry::Poll& poll)
    : impl_(std::make_unique<const Impl>(Impl{verify::split_into_solids(mesh, poll)})) {}
DepthBody::~DepthBody() = default;
DepthBody::DepthBody(DepthBody&&) noexcept = default;
DepthBody& DepthBody::operator=(DepthBody&&) noexcept = default;

namespace verify {
namespace {

using Vec3 = Eigen::Vector3d;

/// Deepest surface point of A in B. `place` maps A to the frame of B, `frame` maps that frame to the world.
class Descent {
 public:
  Descent(const Solid& a, const Solid& b, const Placement& place, const DepthSearch& search, const Pose& frame,
          Penetration& deepest, const RunContext& context)
      : a_(a), b_(b), place_(place), search_(search), frame_(frame), deepest_(deepest), context_(context) {}

  /// Returns true if one shrunken copy of all of A stays off the surface of B.
  bool run() {
    if (first_round()) return true;
    if (stopped_) return false;
    std::uint64_t sampled = 0;
    for (const Patch& patch : open_) {
      for (const auto& p : patch.p) sample(place_ * p);
      sample(place_ * patch.center());
      if (deepest_.depth >= search_.enough || told_to_stop(++sampled)) return false;
    }
    std::uint64_t left = 100'000;  // patches: the deepest point is mostly among the first thousands
    while (!open_.empty() && left-- > 0) {
      if (deepest_.depth >= search_.enough || told_to_stop(left)) return false;
      const Patch patch = open_.front();
      open_.pop_front();
      std::optional<Ridge> ridge;
      if (is_left_out(patch) || settled(patch, ridge)) continue;
      if (ridge) {
        for (const Patch& half : patch.halves(ridge->edge, ridge->t)) open_.push_back(half);
      } else {
        for (const Patch& quarter : patch.quarters()) open_.push_back(quarter);
      }
    }
    return false;
  }

 private:
  bool told_to_stop(std::uint64_t count) const { return count % 64 == 0 && context_.should_stop(); }
  double level() const { return deepest_.depth + search_.tolerance * (1 - geometry::kRounding); }

  /// `x` in the frame of B.
  void found(double depth, const Vec3& x) {
    if (depth > deepest_.depth && !is_left_out(x)) deepest_ = {depth, frame_ * x};
  }

  /// `x` in the frame of B.
  bool is_left_out(const Vec3& x) const {
    return search_.left_out != nullptr &&
           (search_.left_out->contains(b_.frame * x) ||
            search_.left_out->contains(a_.frame * Vec3(place_.r.transpose() * (x - place_.t))));
  }

  /// True if the box contains the whole patch in one of the two frames.
  bool is_left_out(const Patch& patch) const {
    if (search_.left_out == nullptr) return false;
    const auto all_in = [&](const auto& to_part) {
      return std::all_of(patch.p.begin(), patch.p.end(),
                         [&](const Vec3& p) { return search_.left_out->contains(to_part(p)); });
    };
    return all_in([&](const Vec3& p) -> Vec3 { return a_.frame * p; }) ||
           all_in([&](const Vec3& p) -> Vec3 { return b_.frame * Vec3(place_ * p); });
  }

  double sample(const Vec3& x) {
    if (b_.box.squared_distance(x) > 0) return 0;
    const double d = escape_at(x, b_).depth;
    found(d, x);
    return d;
  }

  SweepResult test(const Corners& moved) const {
    const Corners c = placed(place_, moved);
    return Sweep(c, c, 0).test(b_.bvh);
  }
  bool clear_outside(const Corners& moved) const {
    const SweepResult seen = test(moved);
    if (seen == SweepResult::unclear) return false;
    return seen == SweepResult::far || !b_.bvh.inside(place_ * ((moved[0] + moved[1] + moved[2]) / 3));
  }

  /// Applies the vertex rule to every triangle of A. Triangles that it does not settle are put in open_.
  bool first_round() {
    const double e = level();
    std::vector<Patch> clear;
    std::uint64_t seen_so_far = 0;
    bool some_left_out = false;
    collect(0, [&](const Patch& patch) {
      stopped_ = stopped_ || told_to_stop(++seen_so_far);
      if (stopped_) return;
      if (is_left_out(patch)) {
        some_left_out = true;
        return;
      }
      const SweepResult seen = test(moved_by_vertices(patch, e));
      if (seen == SweepResult::unclear)
        open_.push_back(patch);
      else if (seen == SweepResult::clear)
        clear.push_back(patch);
    });
    if (stopped_) return false;
    if (open_.empty() && !some_left_out) {
      bool all_outside = true;
      for (std::size_t k = 0; k + 1 < a_.shell_begin.size() && all_outside; ++k) {
        const std::uint32_t v = a_.shell_vertices[a_.shell_begin[k]];
        all_outside = !b_.bvh.inside(place_ * (a_.mesh.vertices[v] + e * a_.inward[v]));
      }
      if (all_outside) return true;
    }
    for (const Patch& patch : clear) {
      const Corners m = moved_by_vertices(patch, e);
      if (b_.bvh.inside(place_ * ((m[0] + m[1] + m[2]) / 3))) open_.push_back(patch);
    }
    return false;
  }

  template <class F>
  void collect(std::uint32_t id, const F& f) const {
    if (a_.bvh.nodes().empty()) return;
    const TriangleBvh::Node& node = a_.bvh.nodes()[id];
    const Vec3 c = place_ * node.box.center(), h = place_.r.cwiseAbs() * (0.5 * node.box.size());
    if (!Aabb{c - h, c + h}.overlaps(b_.box)) return;  // points outside the box of B have no depth
    if (node.count == 0) {
      collect(id + 1, f);
      collect(node.first, f);
      return;
    }
    for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
      const std::uint32_t t = a_.bvh.order()[k];
      const Triangle& v = a_.mesh.triangles[t];
      f(Patch{a_.bvh.corners(t), {a_.inward[v[0]], a_.inward[v[1]], a_.inward[v[2]]}, t});
    }
  }

  /// True if nothing of the patch is deeper than level(). Else `ridge` is the best place to divide it, if there is one.
  bool settled(const Patch& patch, std::optional<Ridge>& ridge) {
    if (clear_outside(moved_by_vertices(patch, level()))) return true;
    if (clear_outside(moved_along(patch, -a_.normals[patch.triangle], level()))) return true;
    const Probe seen = probe(patch, place_, b_);
    const auto deepest = static_cast<std::size_t>(seen.deepest);
    found(seen.depth[deepest], place_ * patch.p[deepest]);
    if (clear_outside(moved_by_probe(patch, seen, level()))) return true;
    const Escape center = escape_at(place_ * patch.center(), b_);
    found(center.depth, place_ * patch.center());
    if (center.depth + patch.radius() <= level()) return true;
    if (clear_outside(moved_along(patch, place_.r.transpose() * center.out, level()))) return true;
    ridge = ridge_on(patch, seen);
    return false;
  }

  const Solid& a_;
  const Solid& b_;
  const Placement& place_;
  const DepthSearch& search_;
  const Pose& frame_;
  Penetration& deepest_;
  const RunContext& context_;
  bool stopped_ = false;  // in the first round
  std::deque<Patch> open_;
};

/// The smallest displacement of one of two parts, one of which is open, that takes it off the other, exact to
/// `tolerance` from above; 0 up to `tolerance`. nullopt: none does.
std::optional<Penetration> wall_depth(const Solid& a, const Pose& place_a, const Solid& b, const Pose& place_b,
                                      double tolerance, const RunContext& context) {
  const Pose a_in_b = place_b.inverse() * place_a;
  Vec3 meets = Vec3::Zero();
  const auto apart = [&](double depth) { return geometry::apart_by(a, b, a_in_b, depth, meets); };
  if (apart(tolerance)) return Penetration{};
  // A copy that is displaced further than needed meets the next wall, so larger displacements may fail again: four
  // steps for each doubling.
  const double step = std::exp2(0.25);
  const double most = 0.5 * std::max(a.box.size().norm(), b.box.size().norm());
  double low = tolerance, high = step * tolerance;
  for (; !apart(high); high *= step) {
    if (high > most || context.should_stop()) return std::nullopt;
    low = high;
  }
  while (high - low > tolerance && !context.should_stop()) {
    const double middle = 0.5 * (low + high);
    (apart(middle) ? high : low) = middle;
  }
  return Penetration{high, place_b * meets};
}

}  // namespace
}  // namespace verify

Penetration deepest_penetration(const DepthBody& a, const Pose& pose_a, const DepthBody& b, const Pose& pose_b,
                                const DepthSearch& search, const RunContext& context) {
  const double tolerance = search.tolerance, enough = search.enough;
  if (!(tolerance > 0)) throw std::invalid_argument("penetration_depth: tolerance must be > 0");
  using verify::Placement;
  Penetration deepest{search.from};
  for (const auto& x : a.impl().solids)
    for (const auto& y : b.impl().solids) {
      const Pose place_x = pose_a * x.frame, place_y = pose_b * y.frame;
      const Placement a_in_b(place_y.inverse() * place_x), b_in_a(place_x.inverse() * place_y);
      const Eigen::Vector3d c = a_in_b * x.box.center(), h = a_in_b.r.cwiseAbs() * (0.5 * x.box.size());
      if (!Aabb{c - h, c + h}.overlaps(y.box)) continue;
      if (x.open || y.open)
        if (const auto walls = verify::wall_depth(x, place_x, y, place_y, tolerance, context)) {
          if (walls->depth > deepest.depth) deepest = *walls;
          continue;
        }
      const bool swap = y.mesh.triangles.size() < x.mesh.triangles.size();
      const verify::Solid &first = swap ? y : x, &second = swap ? x : y;
      const Placement &there = swap ? b_in_a : a_in_b, &back = swap ? a_in_b : b_in_a;
      const Pose &first_frame = swap ? place_y : place_x, &second_frame = swap ? place_x : place_y;
      const double before = deepest.depth;
      const bool shrunken = verify::Descent(first, second, there, search, second_frame, deepest, context).run();
      // As in pair_check.cpp: then no point of the second is deeper in the first either.
      if (shrunken && verify::starts_off(second, first, back, before + tolerance)) continue;
      if (deepest.depth >= enough || context.should_stop()) return deepest;
      verify::Descent(second, first, back, search, first_frame, deepest, context).run();
      if (deepest.depth >= enough) return deepest;
    }
  return deepest;
}

Penetration deepest_penetration(const DepthBody& a, const Pose& pose_a, const DepthBody& b, const Pose& pose_b,
                                double tolerance) {
  return deepest_penetration(a, pose_a, b, pose_b, DepthSearch{tolerance}, RunContext{});
}

double penetration_depth(const DepthBody& a, const Pose& pose_a, const DepthBody& b, const Pose& pose_b,
                         double tolerance) {
  return deepest_penetration(a, pose_a, b, pose_b, tolerance).depth;
}

double penetration_depth(const Mesh& a, const Pose& pose_a, const Mesh& b, const Pose& pose_b, double tolerance) {
  return penetration_depth(DepthBody(a), pose_a, DepthBody(b), pose_b, tolerance);
}

}  // namespace dismantle
