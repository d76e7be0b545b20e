#include "interlock_lp/interlock.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "interlock_lp/body_coordinates.h"
#include "interlock_lp/pair_rows.h"

namespace dismantle::immobility {
namespace {

using Eigen::VectorXd;
using Vec3 = Eigen::Vector3d;
using PolytopeX = PolytopeIn<Eigen::Dynamic>;

constexpr double kFirst = 2;       // depths: the bounds at first, of shifts and of the points of bodies that turn
constexpr double kWider = 1.02;    // than what was found
constexpr double kMostGrowth = 2;  // of a bound, in a round
constexpr double kAround = 4;      // the linear programs look so much further than the bounds
constexpr double kStrictly = 1e-9;
constexpr int kMostCuts = 200;  // rounds of adding rows to a linear program; it is a bound without them

struct Bounds {
  VectorXd lo, hi;

  explicit Bounds(Eigen::Index size = 0) : lo(VectorXd::Zero(size)), hi(VectorXd::Zero(size)) {}
  VectorXd most() const { return lo.cwiseAbs().cwiseMax(hi.cwiseAbs()); }
  bool strictly_within(const Bounds& other) const {
    return (lo.array() > other.lo.array() + kStrictly).all() && (hi.array() < other.hi.array() - kStrictly).all();
  }
  void widen_to(const Bounds& other) {
    lo = lo.cwiseMin((kWider * other.lo).cwiseMax(kMostGrowth * lo));
    hi = hi.cwiseMax((kWider * other.hi).cwiseMin(kMostGrowth * hi));
  }
};

/// Body a seen from body b.
struct Pair {
  std::size_t a, b;
  std::unique_ptr<Pinned> pinned;
  Vec3 center_b_to_a;
  Bounds bounds{6};
};

/// What one pair says of the coordinates x of all bodies: its own are map x, and no more than `rest` from there.
struct PairView {
  Eigen::MatrixXd map;
  Vector6 rest;
  Eigen::Matrix<double, Eigen::Dynamic, 6> normals;
  VectorXd most;
};

/// Linear programs over all rows of all pairs, of which few matter.
class Program {
 public:
  Program(const std::vector<PairView>& pairs, const VectorXd& most) : pairs_(pairs) {
    used_.hi = most;
    used_.lo = -most;
  }

  /// No point has more; infinity where that is not known.
  double bound(const VectorXd& direction) {
    double value = std::numeric_limits<double>::infinity();
    bool more = true;
    for (int k = 0; k < kMostCuts && more; ++k) {
      const auto found = maximum(direction, used_);
      if (found.empty) break;
      value = std::min(value, found.value);
      more = false;
      for (const PairView& pair : pairs_) {
        Eigen::Index worst = 0;
        if (pair.most.size() == 0 || !((pair.normals * (pair.map * found.at) - pair.most).maxCoeff(&worst) > kStrictly))
          continue;
        used_.add(pair.map.transpose() * pair.normals.row(worst).transpose(), pair.most[worst]);
        more = true;
      }
    }
    return value;
  }

 private:
  const std::vector<PairView>& pairs_;
  PolytopeX used_;
};

class Region {
 public:
  Region(const std::vector<const std::vector<Solid>*>& bodies, const std::vector<Neighbours>& neighbours)
      : axes_(bodies.front()->front().frame.q), bounds_(6 * (static_cast<Eigen::Index>(bodies.size()) - 1)) {
    std::vector<Vec3> centers;
    std::vector<double> radii, depths(bodies.size(), 0.0);
    for (const auto* solids : bodies) {
      Aabb box;
      for (const Solid& s : *solids)
        for (const Vec3& v : s.mesh.vertices) box.extend(s.frame * v);
      centers.push_back(box.center());
      radii.push_back(0.5 * box.size().norm());
    }
    for (Neighbours n : neighbours) {
      if (n.a == 0 || (n.b != 0 && radii[n.b] < radii[n.a])) std::swap(n.a, n.b);
      Pair pair{n.a, n.b, std::make_unique<Pinned>(*bodies[n.a], *bodies[n.b], n.depth),
                axes_.conjugate() * (centers[n.a] - centers[n.b])};
      pair.bounds.hi << Vec3::Constant(kFirst * n.depth / radii[n.a]), Vec3::Constant(kFirst * n.depth);
      pair.bounds.lo = -pair.bounds.hi;
      pairs_.push_back(std::move(pair));
      for (const std::size_t i : {n.a, n.b}) depths[i] = std::max(depths[i], n.depth);
    }
    for (std::size_t i = 1; i < bodies.size(); ++i)
      bounds_.hi.segment<6>(first(i)) << Vec3::Constant(kFirst * depths[i] / radii[i]),
          Vec3::Constant(kFirst * depths[i]);
    bounds_.lo = -bounds_.hi;
    radii_ = radii;
  }

  std::optional<InterlockReach> close(int max_rounds, const RunContext& context) {
    for (int round = 0; round < max_rounds && !context.should_stop(); ++round) {
      if (!small()) return std::nullopt;
      Bounds all(bounds_.lo.size());
      std::vector<Bounds> of_pairs;
      std::size_t rows = 0;
      if (!bound(all, of_pairs, rows)) return std::nullopt;
      bool closed = all.strictly_within(bounds_);
      for (std::size_t k = 0; k < pairs_.size(); ++k) closed = closed && of_pairs[k].strictly_within(pairs_[k].bounds);
      if (closed) return reach(rows);
      bounds_.widen_to(all);
      for (std::size_t k = 0; k < pairs_.size(); ++k) pairs_[k].bounds.widen_to(of_pairs[k]);
    }
    return std::nullopt;
  }

 private:
  static Eigen::Index first(std::size_t body) { return 6 * (static_cast<Eigen::Index>(body) - 1); }

  BodyReach reach_of(std::size_t body) const {
    BodyReach r;
    if (body > 0) r.most = bounds_.most().segment<6>(first(body));
    return r;
  }

  bool small() const {
    for (std::size_t i = 1; i < radii_.size(); ++i)
      if (const BodyReach r = reach_of(i); !r.small() || r.most.tail<3>().norm() > radii_[i]) return false;
    return true;
  }

  PairView view(const Pair& pair) const {
    const SeenFrom seen =
        seen_from(reach_of(pair.a), reach_of(pair.b), pair.center_b_to_a, Vector6(pair.bounds.most()));
    PairView view{Eigen::MatrixXd::Zero(6, bounds_.lo.size()), seen.rest, {}, {}};
    view.map.middleCols<6>(first(pair.a)) += seen.of_a;
    if (pair.b > 0) view.map.middleCols<6>(first(pair.b)) += seen.of_b;
    const auto rows = pair_rows(*pair.pinned, axes_, pair.bounds.lo, pair.bounds.hi);
    view.normals.resize(static_cast<Eigen::Index>(rows.size()), 6);
    view.most.resize(view.normals.rows());
    for (Eigen::Index r = 0; r < view.normals.rows(); ++r) {
      const PairRow& row = rows[static_cast<std::size_t>(r)];
      view.normals.row(r) = row.normal;
      view.most[r] = row.most + row.normal.cwiseAbs().dot(seen.rest);
    }
    return view;
  }

  /// The new bounds, over all poses within the old ones. False: nothing can be said.
  bool bound(Bounds& all, std::vector<Bounds>& of_pairs, std::size_t& rows) {
    std::vector<PairView> views;
    for (const Pair& pair : pairs_) views.push_back(view(pair));
    for (const PairView& v : views) rows += static_cast<std::size_t>(v.most.size());
    Program program(views, kAround * bounds_.most());
    const auto interval = [&](const VectorXd& direction, double rest, double& lo, double& hi) {
      hi = program.bound(direction) + rest;
      lo = -program.bound(-direction) - rest;
      return std::isfinite(hi) && std::isfinite(lo);
    };
    for (Eigen::Index i = 0; i < bounds_.lo.size(); ++i)
      if (!interval(VectorXd::Unit(bounds_.lo.size(), i), 0, all.lo[i], all.hi[i])) return false;
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      of_pairs.emplace_back(6);
      for (int i = 0; i < 6; ++i)
        if (!interval(views[k].map.row(i), views[k].rest[i], of_pairs[k].lo[i], of_pairs[k].hi[i])) return false;
    }
    return true;
  }

  InterlockReach reach(std::size_t rows) const {
    InterlockReach r;
    for (std::size_t i = 1; i < radii_.size(); ++i) {
      const BodyReach body = reach_of(i);
      r.shift = std::max(r.shift, body.most.tail<3>().norm());
      r.turn = std::max(r.turn, body.most.head<3>().norm());
    }
    r.half_spaces = rows;
    return r;
  }

  Eigen::Quaterniond axes_;  // along the largest faces of the first body: there the bounds are tightest
  Bounds bounds_;            // of all bodies but the first
  std::vector<Pair> pairs_;
  std::vector<double> radii_;
};

}  // namespace

std::optional<InterlockReach> interlock(const std::vector<const std::vector<Solid>*>& bodies,
                                        const std::vector<Neighbours>& neighbours, int max_rounds,
                                        const RunContext& context) {
  if (!std::all_of(bodies.begin(), bodies.end(),
                   [](const auto* solids) { return !solids->empty() && borderless(*solids); }))
    return std::nullopt;
  for (std::size_t i = 0; i < bodies.size(); ++i)  // with nobody near
    if (std::none_of(neighbours.begin(), neighbours.end(), [&](const Neighbours& n) { return n.a == i || n.b == i; }))
      return std::nullopt;
  return Region(bodies, neighbours).close(max_rounds, context);
}

}  // namespace dismantle::immobility
