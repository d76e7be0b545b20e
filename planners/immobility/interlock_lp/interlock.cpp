#include "interlock_lp/interlock.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include "dismantle/geometry/numerics.h"
#include "interlock_lp/pair_rows.h"
#include "interlock_lp/relative_coordinates.h"

namespace dismantle::immobility {
namespace {

using Eigen::VectorXd;
using Vec3 = Eigen::Vector3d;
using PolytopeX = PolytopeIn<Eigen::Dynamic>;

struct Bounds {
  VectorXd lo, hi;

  explicit Bounds(Eigen::Index size = 0) : lo(VectorXd::Zero(size)), hi(VectorXd::Zero(size)) {}
  VectorXd most() const { return lo.cwiseAbs().cwiseMax(hi.cwiseAbs()); }
  bool strictly_within(const Bounds& other) const {
    return (lo.array() > other.lo.array() + kRounding).all() && (hi.array() < other.hi.array() - kRounding).all();
  }
  /// Widens to slightly more than `other`, so that the next round can end strictly within. At most doubles the bounds,
  /// since wider bounds have remainders that are too large for the proof.
  void widen_to(const Bounds& other) {
    lo = lo.cwiseMin((1.02 * other.lo).cwiseMax(2 * lo));
    hi = hi.cwiseMax((1.02 * other.hi).cwiseMin(2 * hi));
  }
};

/// The pose of body a relative to body b.
struct Pair {
  std::size_t a, b;
  std::unique_ptr<SampledPair> samples;
  std::size_t solids_of_a;  // they come before those of b among the obstacles
  Vec3 center_b_to_a;
  Bounds bounds{6};
};

/// Constraints of one pair on the coordinates x of all bodies. The relative coordinates are within `rest` of map x.
struct PairConstraints {
  Eigen::MatrixXd map;
  Vector6 rest;
  Eigen::Matrix<double, Eigen::Dynamic, 6> normals;
  VectorXd most;
  std::vector<PairRow> rows;
};

/// A row of one pair.
using RowOfPair = std::pair<std::size_t, Eigen::Index>;

/// Multipliers of rows, for each linear program.
using RecordedMultipliers = std::vector<std::vector<std::pair<RowOfPair, double>>>;

/// Linear programs over the rows of all pairs. Few rows are active, so rows are added when they are violated (cutting
/// planes).
class Program {
 public:
  Program(const std::vector<PairConstraints>& pairs, const VectorXd& most, const RunContext& context)
      : pairs_(pairs), context_(context) {
    used_.hi = most;
    used_.lo = -most;
  }

  /// Upper bound of direction . x; infinity if there is none, or when told to stop. Adds its multipliers to `record`.
  double bound(const VectorXd& direction, RecordedMultipliers& record) {
    auto& proof = record.emplace_back();
    Multipliers multipliers;
    double value = std::numeric_limits<double>::infinity();
    bool more = true;
    for (int k = 0; k < 200 && more; ++k) {  // every round gives a valid bound; a few dozen give the best one
      if (context_.should_stop()) return std::numeric_limits<double>::infinity();
      const auto found = maximum(direction, used_, &context_, &multipliers);
      if (found.empty) break;
      if (found.value < value) {
        value = found.value;
        proof.clear();
        for (const auto& [row, y] : multipliers) proof.emplace_back(sources_[row], y);
      }
      more = false;
      for (std::size_t p = 0; p < pairs_.size(); ++p) {
        const PairConstraints& pair = pairs_[p];
        Eigen::Index worst = 0;
        if (pair.most.size() == 0 || !((pair.normals * (pair.map * found.at) - pair.most).maxCoeff(&worst) > kRounding))
          continue;
        used_.add(pair.map.transpose() * pair.normals.row(worst).transpose(), pair.most[worst]);
        sources_.emplace_back(p, worst);
        more = true;
      }
    }
    return value;
  }

 private:
  const std::vector<PairConstraints>& pairs_;
  const RunContext& context_;
  PolytopeX used_;
  std::vector<RowOfPair> sources_;  // of its rows
};

class Region {
 public:
  Region(const std::vector<const std::vector<Solid>*>& bodies, const std::vector<Neighbours>& neighbours,
         double spacing)
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
      Pair pair{n.a, n.b, std::make_unique<SampledPair>(*bodies[n.a], *bodies[n.b], n.depth, spacing),
                bodies[n.a]->size(), axes_.conjugate() * (centers[n.a] - centers[n.b])};
      // Two depths: parts that touch on both sides move about as far as they may penetrate.
      pair.bounds.hi << Vec3::Constant(2 * n.depth / radii[n.a]), Vec3::Constant(2 * n.depth);
      pair.bounds.lo = -pair.bounds.hi;
      pairs_.push_back(std::move(pair));
      for (const std::size_t i : {n.a, n.b}) depths[i] = std::max(depths[i], n.depth);
    }
    for (std::size_t i = 1; i < bodies.size(); ++i)
      bounds_.hi.segment<6>(first(i)) << Vec3::Constant(2 * depths[i] / radii[i]), Vec3::Constant(2 * depths[i]);
    bounds_.lo = -bounds_.hi;
    radii_ = radii;
  }

  std::optional<InterlockReach> close(int max_rounds, const RunContext& context) {
    for (int round = 0; round < max_rounds && !context.should_stop(); ++round) {
      if (!small()) return std::nullopt;
      Bounds all(bounds_.lo.size());
      std::vector<Bounds> of_pairs;
      InterlockProof proof;
      if (!bound(all, of_pairs, proof, context)) return std::nullopt;
      bool closed = all.strictly_within(bounds_);
      for (std::size_t k = 0; k < pairs_.size(); ++k) closed = closed && of_pairs[k].strictly_within(pairs_[k].bounds);
      if (closed) return reach(std::move(proof));
      bounds_.widen_to(all);
      for (std::size_t k = 0; k < pairs_.size(); ++k) pairs_[k].bounds.widen_to(of_pairs[k]);
    }
    return std::nullopt;
  }

 private:
  static Eigen::Index first(std::size_t body) { return 6 * (static_cast<Eigen::Index>(body) - 1); }

  CoordinateBound reach_of(std::size_t body) const {
    CoordinateBound r;
    if (body > 0) r.most = bounds_.most().segment<6>(first(body));
    return r;
  }

  bool small() const {
    for (std::size_t i = 1; i < radii_.size(); ++i)
      if (const CoordinateBound r = reach_of(i); !r.small() || r.most.tail<3>().norm() > radii_[i]) return false;
    return true;
  }

  PairConstraints constraints_of(const Pair& pair) const {
    const RelativeCoordinates relative =
        relative_coordinates(reach_of(pair.a), reach_of(pair.b), pair.center_b_to_a, Vector6(pair.bounds.most()));
    PairConstraints result{Eigen::MatrixXd::Zero(6, bounds_.lo.size()), relative.rest, {}, {}, {}};
    result.map.middleCols<6>(first(pair.a)) += relative.of_a;
    if (pair.b > 0) result.map.middleCols<6>(first(pair.b)) += relative.of_b;
    result.rows = pair_rows(*pair.samples, axes_, pair.bounds.lo, pair.bounds.hi);
    const auto& rows = result.rows;
    result.normals.resize(static_cast<Eigen::Index>(rows.size()), 6);
    result.most.resize(result.normals.rows());
    for (Eigen::Index r = 0; r < result.normals.rows(); ++r) {
      const PairRow& row = rows[static_cast<std::size_t>(r)];
      result.normals.row(r) = row.normal;
      result.most[r] = row.most + row.normal.cwiseAbs().dot(relative.rest);
    }
    return result;
  }

  /// Computes new bounds over all poses within the old ones. False: a linear program has no bound, or told to stop.
  bool bound(Bounds& all, std::vector<Bounds>& of_pairs, InterlockProof& proof, const RunContext& context) {
    std::vector<PairConstraints> constraints;
    for (const Pair& pair : pairs_) {
      if (context.should_stop()) return false;
      constraints.push_back(constraints_of(pair));
    }
    RecordedMultipliers record;
    // Twice the growth limit of a round, so that the box of the linear programs never decides the bound.
    Program program(constraints, 4 * bounds_.most(), context);
    const auto interval = [&](const VectorXd& direction, double rest, double& lo, double& hi) {
      hi = program.bound(direction, record) + rest;
      lo = -program.bound(-direction, record) - rest;
      return std::isfinite(hi) && std::isfinite(lo);
    };
    for (Eigen::Index i = 0; i < bounds_.lo.size(); ++i)
      if (!interval(VectorXd::Unit(bounds_.lo.size(), i), 0, all.lo[i], all.hi[i])) return false;
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      of_pairs.emplace_back(6);
      for (int i = 0; i < 6; ++i)
        if (!interval(constraints[k].map.row(i), constraints[k].rest[i], of_pairs[k].lo[i], of_pairs[k].hi[i]))
          return false;
    }
    proof = proof_of(constraints, record);
    return true;
  }

  /// The bounds that were assumed, and the rows that have multipliers.
  InterlockProof proof_of(const std::vector<PairConstraints>& constraints, const RecordedMultipliers& record) const {
    InterlockProof proof;
    proof.axes = {axes_.w(), axes_.x(), axes_.y(), axes_.z()};
    const auto add = [](std::vector<double>& to, const VectorXd& v) { to.insert(to.end(), v.begin(), v.end()); };
    for (Eigen::Index i = 0; i < bounds_.lo.size(); i += 6) {
      add(proof.bounds, bounds_.lo.segment<6>(i));
      add(proof.bounds, bounds_.hi.segment<6>(i));
    }
    for (const Pair& pair : pairs_) {
      proof.pairs.insert(proof.pairs.end(), {static_cast<double>(pair.a), static_cast<double>(pair.b)});
      add(proof.pairs, pair.bounds.lo);
      add(proof.pairs, pair.bounds.hi);
    }
    std::map<RowOfPair, double> known;
    for (const auto& program : record) {
      proof.multipliers.push_back(static_cast<double>(program.size()));
      for (const auto& [at, y] : program) {
        const auto [row, fresh] = known.try_emplace(at, static_cast<double>(known.size()));
        proof.multipliers.insert(proof.multipliers.end(), {row->second, y});
        if (!fresh) continue;
        const Pair& pair = pairs_[at.first];
        const PairRow& made = constraints[at.first].rows[static_cast<std::size_t>(at.second)];
        const std::size_t solid = made.sample->obstacle - (made.sample->of_a ? pair.solids_of_a : 0);
        proof.rows.insert(proof.rows.end(),
                          {static_cast<double>(at.first), made.sample->of_a ? 1.0 : 0.0, static_cast<double>(solid)});
        add(proof.rows, Vec3(made.sample->at + pair.samples->center()));
        add(proof.rows, made.direction);
      }
    }
    return proof;
  }

  InterlockReach reach(InterlockProof proof) const {
    InterlockReach r;
    for (std::size_t i = 1; i < radii_.size(); ++i) {
      const CoordinateBound body = reach_of(i);
      r.shift = std::max(r.shift, body.most.tail<3>().norm());
      r.turn = std::max(r.turn, body.most.head<3>().norm());
    }
    r.half_spaces = proof.rows.size() / 9;
    r.proof = std::move(proof);
    return r;
  }

  Eigen::Quaterniond axes_;  // along the largest faces of the first body, where bounds by component are tightest
  Bounds bounds_;            // of all bodies but the first
  std::vector<Pair> pairs_;
  std::vector<double> radii_;
};

}  // namespace

std::optional<InterlockReach> interlock(const std::vector<const std::vector<Solid>*>& bodies,
                                        const std::vector<Neighbours>& neighbours, double spacing, int max_rounds,
                                        const RunContext& context) {
  if (!std::all_of(bodies.begin(), bodies.end(),
                   [](const auto* solids) { return !solids->empty() && all_closed(*solids); }))
    return std::nullopt;
  for (std::size_t i = 0; i < bodies.size(); ++i)  // a body without neighbours is free
    if (std::none_of(neighbours.begin(), neighbours.end(), [&](const Neighbours& n) { return n.a == i || n.b == i; }))
      return std::nullopt;
  return Region(bodies, neighbours, spacing).close(max_rounds, context);
}

}  // namespace dismantle::immobility
