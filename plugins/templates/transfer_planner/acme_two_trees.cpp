// acme.two_trees: a transfer planner. Two random trees of displacements, from the start pose and from the goal pose
// of the parts, grow towards each other (RRT-Connect).
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "dismantle/plugin.h"

namespace {

using dismantle::Pose;
using Eigen::Vector3d;

struct AcmeTwoTreesParameters {
  double range = 1;
  double step = 0.05;
  double share = 0.4;
  std::int64_t max_checks = 30'000;

  static void describe(dismantle::Schema<AcmeTwoTreesParameters>& s) {
    s.add("range", &AcmeTwoTreesParameters::range,
          {.unit = "radii of the group", .min = 0, .min_open = true, .doc = "Longest extension of a tree."});
    s.add("step", &AcmeTwoTreesParameters::step,
          {.unit = "radii of the group",
           .min = 0,
           .max = 1,
           .min_open = true,
           .doc = "Distance between neighbouring state checks on an extension."});
    s.add(
        "share", &AcmeTwoTreesParameters::share,
        {.unit = "1", .min = 0, .max = 1, .doc = "Share of the verifier's tolerance by which a state may penetrate."});
    s.add("max_checks", &AcmeTwoTreesParameters::max_checks,
          {.unit = "1", .min = 0, .doc = "Most state checks for one transfer; 0 = only the limit of the run."});
  }
};

constexpr dismantle::Capabilities kNeeds{.distance = true};

/// One transfer. A configuration is the displacement of the whole group from its start pose.
class Transfer {
 public:
  Transfer(const AcmeTwoTreesParameters& params, const dismantle::TransferQuery& query, dismantle::RunContext& context)
      : params_(params), query_(query), context_(context) {
    world_ = query.simulator.world(query.assembly, query.prepared, query.scene, dismantle::MotionSpace::rigid);
    start_ = world_->initial_state();
    goal_ = query.goal[0] * start_.bodies[0].pose.inverse();  // equal for all parts of the group
    dismantle::Aabb group;
    for (const auto& part : query.scene.moving) extend(group, part, Pose{});
    center_ = group.center();
    radius_ = 0.5 * group.size().norm();
    room_ = group;
    for (const auto& part : query.scene.moving) extend(room_, part, goal_);
    for (const auto& part : query.scene.fixed) extend(room_, part, Pose{});
    room_.inflate(2 * radius_);
  }

  dismantle::PathResult solve() {
    dismantle::PathResult result;
    if (!free(Pose{}) || !free(goal_)) {
      result.fail(stopped() ? end() : dismantle::Outcome::invalid_start, "the parts collide at one of the two ends");
    } else {
      result.fail(dismantle::Outcome::timeout, "the two trees did not meet");
      while (!stopped()) {
        const std::vector<Pose> displacements = shortened(connect());
        if (displacements.empty()) break;
        const auto check = query_.checker.check(path_of(displacements));
        if (check.accepted()) {
          result.solve(*check.verified, static_cast<unsigned>(displacements.size() - 1));
          break;
        }
        ++result.stats.refused;  // other trees may find another path
        result.message = check.reason;
      }
      if (!is_success(result.outcome())) result.fail(end());
    }
    result.stats.state_checks = checks_;
    result.stats.cost = static_cast<double>(checks_);
    return result;
  }

 private:
  struct Node {
    Pose displacement;
    std::size_t parent = 0;  // the root is its own parent
  };
  using Tree = std::vector<Node>;

  bool stopped() const {
    const auto own = static_cast<std::uint64_t>(params_.max_checks);
    return context_.should_stop() || (own > 0 && checks_ >= own) ||
           (query_.budget.max_steps > 0 && checks_ >= query_.budget.max_steps);
  }
  dismantle::Outcome end() const {
    return context_.cancel.cancelled() ? dismantle::Outcome::cancelled : dismantle::Outcome::timeout;
  }

  bool free(const Pose& displacement) {
    if (stopped()) return false;
    ++checks_;
    dismantle::State state = start_;
    for (auto& body : state.bodies) body.pose = displacement * body.pose;
    return world_->penetration(state) <= params_.share * query_.tolerance;
  }
  /// Upper bound of the travel of all points of the group from a to b.
  double distance(const Pose& a, const Pose& b) const { return dismantle::screw_travel(a, b, center_, radius_); }
  /// True if all checked states on the screw motion from a to b are free; a itself must be free.
  bool free_between(const Pose& a, const Pose& b) {
    if (dismantle::angle_between(a.q, b.q) > 0.9 * std::numbers::pi)
      return false;  // near half a turn the direction is ambiguous
    const auto states = std::max(1.0, std::ceil(distance(a, b) / (params_.step * radius_)));
    for (double k = 1; k <= states; ++k)
      if (!free(dismantle::screw_interpolate(a, b, k / states))) return false;
    return true;
  }

  std::size_t nearest(const Tree& tree, const Pose& to) const {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < tree.size(); ++i) {
      const double d = distance(tree[i].displacement, to);
      if (d < least) least = d, best = i;
    }
    return best;
  }

  /// One extension towards `to`. Returns true if it reached `to`; sets `grown` if the tree has grown.
  bool extend_towards(Tree& tree, const Pose& to, bool& grown) {
    const std::size_t from = nearest(tree, to);
    const Pose begin = tree[from].displacement;
    const double d = distance(begin, to), range = params_.range * radius_;
    const Pose next = d <= range ? to : dismantle::screw_interpolate(begin, to, range / d);
    grown = free_between(begin, next);
    if (grown) tree.push_back({next, from});
    return grown && d <= range;
  }

  /// The displacements from start to goal; empty when time or budget is used up.
  std::vector<Pose> connect() {
    Tree from_start = {{Pose{}, 0}}, from_goal = {{goal_, 0}};
    Tree *a = &from_start, *b = &from_goal;
    Pose target = goal_;  // try the direct motion first
    while (!stopped()) {
      bool grown = false;
      extend_towards(*a, target, grown);
      if (grown) {
        const Pose met = a->back().displacement;
        bool moves = true;
        while (moves && !stopped())
          if (extend_towards(*b, met, moves)) return joined(from_start, from_goal);
      }
      std::swap(a, b);
      target = random_displacement();
    }
    return {};
  }

  static std::vector<Pose> branch(const Tree& tree) {
    std::vector<Pose> displacements;
    for (std::size_t i = tree.size() - 1;; i = tree[i].parent) {
      displacements.push_back(tree[i].displacement);
      if (tree[i].parent == i) return displacements;
    }
  }
  static std::vector<Pose> joined(const Tree& from_start, const Tree& from_goal) {
    std::vector<Pose> displacements = branch(from_start);
    std::reverse(displacements.begin(), displacements.end());
    const std::vector<Pose> rest = branch(from_goal);
    displacements.insert(displacements.end(), rest.begin() + 1,
                         rest.end());  // both branches contain the displacement where they meet
    return displacements;
  }

  /// Replaces detours by direct motions.
  std::vector<Pose> shortened(const std::vector<Pose>& displacements) {
    std::vector<Pose> out;
    for (std::size_t i = 0; i < displacements.size();) {
      out.push_back(displacements[i]);
      std::size_t next = i + 1;
      for (std::size_t k = displacements.size(); k-- > i + 2;)
        if (free_between(displacements[i], displacements[k])) {
          next = k;
          break;
        }
      i = next;
    }
    return out;
  }

  /// A random centre of the group in the room; orientation of the start, of the goal, between them, or random.
  Pose random_displacement() {
    Vector3d p;
    for (int k = 0; k < 3; ++k) p[k] = context_.rng.uniform(room_.lo[k], room_.hi[k]);
    Eigen::Quaterniond q = Eigen::Quaterniond::Identity().slerp(context_.rng.uniform(), goal_.q);
    if (context_.rng.below(2) == 0) {
      const Eigen::Vector4d v(context_.rng.normal(), context_.rng.normal(), context_.rng.normal(),
                              context_.rng.normal());
      if (v.norm() > 0) q = Eigen::Quaterniond(v.normalized());
    }
    return {p - q * center_, q};
  }

  dismantle::Path path_of(const std::vector<Pose>& displacements) const {
    dismantle::Path path;
    for (const Pose& displacement : displacements) {
      path.emplace_back();
      for (const auto& body : start_.bodies) path.back().push_back(displacement * body.pose);
    }
    path.front().clear();
    for (const auto& body : start_.bodies) path.front().push_back(body.pose);
    path.back() = query_.goal;
    return path;
  }

  void extend(dismantle::Aabb& box, const dismantle::PlacedPart& part, const Pose& displacement) const {
    for (const auto& v : query_.assembly.parts[part.part].mesh->vertices) box.extend(displacement * part.pose * v);
  }

  const AcmeTwoTreesParameters& params_;
  const dismantle::TransferQuery& query_;
  dismantle::RunContext& context_;
  std::unique_ptr<dismantle::World> world_;
  dismantle::State start_;
  Pose goal_;
  Vector3d center_ = Vector3d::Zero();  // of the group at the start
  double radius_ = 0;
  dismantle::Aabb room_;
  std::uint64_t checks_ = 0;
};

class AcmeTwoTrees final : public dismantle::TransferPlanner {
 public:
  explicit AcmeTwoTrees(const AcmeTwoTreesParameters& params) : params_(params) {}

  dismantle::Capabilities needs() const noexcept override { return kNeeds; }

  dismantle::PathResult plan(const dismantle::TransferQuery& query, dismantle::RunContext& context) override {
    const auto has = query.simulator.capabilities();
    if (!has.distance || has.max_moving < query.scene.moving.size())
      return dismantle::PathResult::failure(
          dismantle::Outcome::unsupported,
          "the simulator does not tell free states of these parts from colliding ones");
    return Transfer(params_, query, context).solve();
  }

 private:
  AcmeTwoTreesParameters params_;
};

}  // namespace

DISMANTLE_PLUGIN("acme.two_trees", "0.1.0", "MIT", "https://example.org") {
  r.add<dismantle::TransferPlanner, AcmeTwoTrees, AcmeTwoTreesParameters>(
      "acme.two_trees", "Two random trees that grow towards each other.",
      {.source = "Kuffner and LaValle 2000", .needs = kNeeds});
}
