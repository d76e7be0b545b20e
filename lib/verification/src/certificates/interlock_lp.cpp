/// interlock_lp: bounds of the poses of all parts, which no motion reaches.
///
/// Poses are relative to one of the parts: a rotation vector about the centre of the part's box, and a shift of that
/// centre, along given axes, all 0 when assembled. The certificate has bounds of these coordinates, and of the relative
/// coordinates of some pairs. As long as the bounds are kept:
/// - The coordinates z of a pair are a matrix times those of all parts, x, up to a bounded remainder.
/// - A point of one part of the pair that is deeper in it than the pair may penetrate never enters the other part,
///   since the other's surface would have to pass it. Its position is linear in z up to a bounded remainder, so it is
///   in a box. The free part of the box lies beyond a plane (FreeBound), which gives a linear inequality for x.
/// - Sums of these with multipliers >= 0 bound every coordinate. All results are strictly within the bounds.
/// So no motion reaches any bound: it would reach one of them first, with the others kept. Within the bounds no part
/// is apart from the others, since one of its points is so deep in their hull that it stays there.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include "certificates/body.h"
#include "certificates/checker.h"
#include "certificates/free_bound.h"
#include "certificates/hull_depth.h"

namespace dismantle::certificates {
namespace {

using Eigen::VectorXd;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Mat3 = Eigen::Matrix3d;

/// w -> v x w
Mat3 cross_with(const Vec3& v) {
  Mat3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// Componentwise bound of |u x v|, from bounds of |u| and |v|.
Vec3 cross_bound(const Vec3& u, const Vec3& v) { return cross_with(u).cwiseAbs() * v; }

/// Componentwise bound of |exp(w) p - p - w x p|, from bounds of |w| and |p|.
Vec3 turn_rest(const Vec3& w, const Vec3& p) {
  return cross_bound(0.5 * w, cross_bound(w, p)) + Vec3::Constant(std::pow(w.norm(), 3) / 6 * p.norm());
}

struct Interval {
  VectorXd lo, hi;
  VectorXd most() const { return lo.cwiseAbs().cwiseMax(hi.cwiseAbs()); }
  bool around_zero() const { return (lo.array() < 0).all() && (hi.array() > 0).all(); }
};

struct Member {
  PartId part = 0;
  Vec3 center = Vec3::Zero();
  const std::vector<Body>* bodies = nullptr;
};

struct Pair {
  std::size_t a = 0, b = 0;
  Interval z;
  Eigen::Matrix<double, 6, Eigen::Dynamic> map;  ///< z is within `rest` of map x
  Vec6 rest = Vec6::Zero();
};

struct Row {
  VectorXd normal;
  double most = 0;  ///< normal . x <= most
};

class Interlock {
 public:
  Interlock(const Certificate& certificate, const SeparationQuery& query, const RunContext& context)
      : numbers_(certificate.numbers), query_(query), context_(context) {
    for (const PartId id : certificate.parts) {
      Member m{id, Vec3::Zero(), &bodies_of(query, id)};
      Aabb box;
      for (const Body& b : *m.bodies) box.extend(b.box);
      m.center = box.center();
      members_.push_back(m);
    }
  }

  std::string objection() {
    if (std::string wrong = read(); !wrong.empty()) return wrong;
    for (std::size_t k = 0; k < list("rows").size(); k += 9) {
      if (context_.should_stop()) return "the check was stopped";
      if (const char* wrong = add_row(&list("rows")[k])) return fmt::format("half space {}: {}", k / 9, wrong);
    }
    if (!multiply()) return "its multipliers do not bound all coordinates";
    for (std::size_t i = 0; i < members_.size() && !context_.should_stop(); ++i)
      if (!stays_among(i)) return "within its bounds a part may be apart from the others";
    return context_.should_stop() ? "the check was stopped" : "";
  }

 private:
  const std::vector<double>& list(const char* name) const { return numbers_.at(name); }
  Eigen::Index first(std::size_t member) const { return 6 * (static_cast<Eigen::Index>(member) - 1); }
  /// Bounds of the absolute values of a member's coordinates; 0 for the first member.
  Vec6 most_of(std::size_t member) const {
    return member == 0 ? Vec6(Vec6::Zero()) : Vec6(x_.most().segment<6>(first(member)));
  }

  std::string read() {
    const auto& order = list("order");
    std::vector<Member> ordered;
    for (const double at : order) {
      if (!(at >= 0) || !(at < static_cast<double>(members_.size()))) return "its order is not one of its parts";
      const Member& m = members_[static_cast<std::size_t>(at)];
      if (std::any_of(ordered.begin(), ordered.end(), [&](const Member& o) { return o.part == m.part; }))
        return "its order has a part twice";
      ordered.push_back(m);
    }
    const std::size_t n = members_.size();
    if (ordered.size() != n) return "its order is not one of its parts";
    members_ = ordered;
    const auto& q = list("axes");
    axes_ = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
    if (!(std::abs(axes_.norm() - 1) < 1e-9)) return "its axes are no rotation";
    axes_.normalize();
    if (list("bounds").size() != 12 * (n - 1) || list("pairs").size() % 14 != 0 || list("rows").size() % 9 != 0)
      return "its lists have not the right length";
    x_ = {VectorXd(first(n)), VectorXd(first(n))};
    for (std::size_t i = 1; i < n; ++i) {
      x_.lo.segment<6>(first(i)) = Eigen::Map<const Vec6>(&list("bounds")[12 * (i - 1)]);
      x_.hi.segment<6>(first(i)) = Eigen::Map<const Vec6>(&list("bounds")[12 * (i - 1) + 6]);
    }
    if (!x_.around_zero()) return "its bounds do not hold the assembled poses";
    double shift = 0, turn = 0;
    for (std::size_t i = 1; i < n; ++i) {
      shift = std::max(shift, most_of(i).tail<3>().norm());
      turn = std::max(turn, most_of(i).head<3>().norm());
    }
    if (!(turn <= 0.25)) return "its bounds are too wide for the rests";
    if (!(list("shift").front() >= shift * (1 - 1e-9)) || !(list("turn").front() >= turn * (1 - 1e-9)))
      return "its bounds are wider than it says";
    if (!(list("depth").front() >= query_.margin() * (1 - 1e-9))) return "it is about less penetration than is allowed";
    if (list("half_spaces").front() != static_cast<double>(list("rows").size() / 9))
      return "it has not as many half spaces as it says";
    for (std::size_t k = 0; k < list("pairs").size(); k += 14)
      if (!read_pair(&list("pairs")[k])) return "a pair of it is none";
    return {};
  }

  bool read_pair(const double* n) {
    const double count = static_cast<double>(members_.size());
    if (!(n[0] >= 1 && n[0] < count && n[1] >= 0 && n[1] < count)) return false;
    Pair pair;
    pair.a = static_cast<std::size_t>(n[0]);
    pair.b = static_cast<std::size_t>(n[1]);
    pair.z = {Eigen::Map<const Vec6>(n + 2), Eigen::Map<const Vec6>(n + 8)};
    if (pair.a == pair.b || !pair.z.around_zero()) return false;
    // With rotation vectors u, v of a and b: log(exp(-v) exp(u)) = u - v + (u x v) / 2, with a remainder of at most
    // (|u| + |v|)^3 / 2 while |u| + |v| <= 1/2. The shift s of a's centre relative to b, from r = a's centre - b's
    // centre: exp(v) (r + s) = r + s_a - s_b, so s = s_a - s_b - (exp(v) - 1) r - (exp(v) - 1) s.
    const Vec6 of_a = most_of(pair.a), of_b = most_of(pair.b);
    const Vec3 u = of_a.head<3>(), v = of_b.head<3>(), s = pair.z.most().tail<3>();
    const Vec3 r = axes_.conjugate() * (members_[pair.a].center - members_[pair.b].center);
    pair.map.setZero(6, x_.lo.size());
    pair.map.middleCols<6>(first(pair.a)) += Mat6::Identity();
    if (pair.b > 0) {
      Mat6 m = -Mat6::Identity();
      m.block<3, 3>(3, 0) = cross_with(r);  // -(v x r) = r x v
      pair.map.middleCols<6>(first(pair.b)) += m;
      pair.rest.head<3>() = cross_bound(0.5 * u, v) + Vec3::Constant(0.5 * std::pow(u.norm() + v.norm(), 3));
      pair.rest.tail<3>() =
          turn_rest(v, r.cwiseAbs()) + cross_bound(v, s) + Vec3::Constant(0.5 * v.squaredNorm() * s.norm());
    }
    pairs_.push_back(std::move(pair));
    return true;
  }

  /// Returns nullptr if the row holds.
  const char* add_row(const double* n) {
    if (!(n[0] >= 0 && n[0] < static_cast<double>(pairs_.size()))) return "it is about no pair";
    const Pair& pair = pairs_[static_cast<std::size_t>(n[0])];
    const bool of_a = n[1] != 0;
    const Member &own = members_[of_a ? pair.a : pair.b], &other = members_[of_a ? pair.b : pair.a];
    if (!(n[2] >= 0 && n[2] < static_cast<double>(other.bodies->size()))) return "its obstacle is none";
    const Body& obstacle = (*other.bodies)[static_cast<std::size_t>(n[2])];
    const Vec3 point(n[3], n[4], n[5]), direction = Vec3(n[6], n[7], n[8]).normalized();
    if (const char* wrong = objection_to_outside_point(query_, own.part, other.part, obstacle, point)) return wrong;

    // Along the axes, from the centre of a: exp(w) p + s for points of a. In the frame of a: exp(-w) (p - s).
    const Vec3 p = axes_.conjugate() * (point - members_[pair.a].center);
    const Vec3 w = pair.z.most().head<3>(), s = pair.z.most().tail<3>();
    Eigen::Matrix<double, 3, 6> slope;
    slope << -cross_with(p), Mat3::Identity();  // w x p = -(p x w)
    Vec3 rest = turn_rest(w, p.cwiseAbs());
    if (!of_a) {
      slope = -slope;
      rest = turn_rest(w, p.cwiseAbs() + s) + cross_bound(w, s);
    }
    auto& free = free_[{other.part, static_cast<std::size_t>(n[2])}];
    if (!free) free = std::make_unique<FreeBound>(obstacle);
    const Mat3 to_local = (free->frame().conjugate() * axes_).toRotationMatrix();
    const Vec6 middle = 0.5 * (pair.z.lo + pair.z.hi), half = 0.5 * (pair.z.hi - pair.z.lo);
    const Vec3 place = free->frame().conjugate() * point, along = free->frame().conjugate() * direction;
    const Eigen::Matrix<double, 3, 6> local = to_local * slope;
    const double least =
        free->least(place + local * middle, local.cwiseAbs() * half + to_local.cwiseAbs() * rest, along);
    if (!std::isfinite(least)) return "its point has no free place";
    // direction . (place + slope z + rest) >= least
    const Vec6 g = -(local.transpose() * along);
    const double of_rest = (to_local.transpose() * along).cwiseAbs().dot(rest);
    rows_.push_back({pair.map.transpose() * g, direction.dot(point) + of_rest - least + g.cwiseAbs().dot(pair.rest)});
    return nullptr;
  }

  /// Upper bound of target . x from the next multipliers of the list; infinite if they are not usable.
  double bound(const VectorXd& target) {
    const auto& y = list("multipliers");
    const double none = std::numeric_limits<double>::infinity();
    if (at_ >= y.size() || !(y[at_] >= 0 && y[at_] <= static_cast<double>(y.size()))) return none;
    const auto count = static_cast<std::size_t>(y[at_++]);
    if (2 * count > y.size() - at_) return none;
    VectorXd left = target;
    double sum = 0;
    for (std::size_t k = 0; k < count; ++k, at_ += 2) {
      if (!(y[at_] >= 0 && y[at_] < static_cast<double>(rows_.size()) && y[at_ + 1] >= 0)) return none;
      const Row& row = rows_[static_cast<std::size_t>(y[at_])];
      left -= y[at_ + 1] * row.normal;
      sum += y[at_ + 1] * row.most;
    }
    return sum + left.cwiseProduct(x_.lo).cwiseMax(left.cwiseProduct(x_.hi)).sum();
  }

  bool multiply() {
    const auto within = [&](const VectorXd& target, double rest, double lo, double hi) {
      const double strict = 1e-10;  // coordinates are angles and lengths of order 1 or less
      const double upper = bound(target) + rest, lower = -bound(-target) - rest;
      return upper < hi - strict && lower > lo + strict;
    };
    for (Eigen::Index i = 0; i < x_.lo.size(); ++i)
      if (!within(VectorXd::Unit(x_.lo.size(), i), 0, x_.lo[i], x_.hi[i])) return false;
    for (const Pair& pair : pairs_)
      for (Eigen::Index i = 0; i < 6; ++i)
        if (!within(pair.map.row(i).transpose(), pair.rest[i], pair.z.lo[i], pair.z.hi[i])) return false;
    return at_ == list("multipliers").size();
  }

  /// Distance that a point of the part may move within the bounds.
  double travel(std::size_t member, const Vec3& point) const {
    const Vec6 most = most_of(member);
    return most.tail<3>().norm() + most.head<3>().norm() * (point - members_[member].center).norm();
  }

  bool stays_among(std::size_t member) const {
    std::vector<Vec3> own, others;
    double moved = 0;  // bound for the points of all others
    Vec3 middle = Vec3::Zero();
    for (std::size_t i = 0; i < members_.size(); ++i)
      for (const Body& body : *members_[i].bodies)
        for (const Vec3& v : body.vertices) {
          (i == member ? own : others).push_back(v);
          if (i != member) moved = std::max(moved, travel(i, v));
        }
    for (const Vec3& v : own) middle += v / static_cast<double>(own.size());
    std::vector<Vec3> candidates{middle};
    // Any point of the part suffices; about 64 of its vertices are tried.
    for (std::size_t k = 0; k < own.size(); k += 1 + own.size() / 64) candidates.push_back(own[k]);
    return std::any_of(candidates.begin(), candidates.end(), [&](const Vec3& p) {
      return ball_in_hull(p, (moved + travel(member, p)) * (1 + 1e-9), others);
    });
  }

  const std::map<std::string, std::vector<double>>& numbers_;
  const SeparationQuery& query_;
  const RunContext& context_;
  std::vector<Member> members_;  // in the certificate's order
  Eigen::Quaterniond axes_;
  Interval x_;  // 6 coordinates of each member but the first
  std::vector<Pair> pairs_;
  std::vector<Row> rows_;
  std::map<std::pair<PartId, std::size_t>, std::unique_ptr<FreeBound>> free_;
  std::size_t at_ = 0;  // in the list of multipliers
};

}  // namespace

std::string objection_to_interlock_lp(const Certificate& certificate, const SeparationQuery& query,
                                      const RunContext& context) {
  return Interlock(certificate, query, context).objection();
}

}  // namespace dismantle::certificates
