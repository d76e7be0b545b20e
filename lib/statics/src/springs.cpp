#include "springs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>

#include "polygon.h"

namespace dismantle::statics {
namespace {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Eigen::Index;
using Eigen::VectorXd;

/// Weight of the proximal term at least and at most. Small: few programs; large: well-conditioned ones, and few steps
/// of Newton's method from afar.
constexpr double kProximalLeast = 1e-8, kProximalMost = 1;
/// The same for Coulomb's law itself: only against exact singularity.
constexpr double kProximalCoupled = 1e-9;
/// Coulomb: what presses where depends on the stiffness, which is that of an elastic bed: by the area of a contact.
/// Edges and points have this share of the mean.
constexpr double kLeastBed = 0.1;
constexpr int kNewtonSteps = 60, kCoupledSteps = 25, kLineSteps = 12;
constexpr double kLineShare = 0.1;  // of the slope at the start: a shorter step is no better for Newton's method
/// Multiplications for a contact point in a step of Newton's method: law, blocks, line search.
constexpr double kPointWork = 2000;
thread_local double work_of_thread = 0;

}  // namespace

Springs::Springs(const Pile& pile, FrictionLaw law)
    : pile_(pile), law_(law), unit_(0), proximal_(kProximal), proximal_least_(kProximalLeast) {
  Index size = 0;
  for (const Body& b : pile.bodies) {
    first_.push_back(b.fixed ? -1 : size);
    if (!b.fixed) {
      if (!(b.weight > 0 && b.radius > 0)) throw std::invalid_argument("statics: a body that can move has no weight");
      size += 6;
      unit_ += b.weight;
    }
  }
  if (!(unit_ > 0)) unit_ = 1;
  // A chain of n contacts gives way n^2 times as far as one. With Coulomb's law steps are no longer than that takes:
  // far away, a certificate's tolerance is large.
  const auto bodies = static_cast<double>(std::max<Index>(1, size / 6));
  if (law == FrictionLaw::coulomb) proximal_least_ = std::min(kProximal, 100 * kProximal / (bodies * bodies));
  load_ = VectorXd::Zero(size);
  scale_ = VectorXd::Ones(size);
  for (std::size_t i = 0; i < pile.bodies.size(); ++i) {
    const Body& b = pile.bodies[i];
    share_.push_back(b.weight / unit_);
    if (b.fixed) continue;
    load_.segment<3>(first_[i]) = share_[i] * pile.down;
    scale_.segment<3>(first_[i]).setConstant(1 / std::sqrt(share_[i]));
    scale_.segment<3>(first_[i] + 3).setConstant(1 / (std::sqrt(share_[i]) * b.radius));
  }
  for (const Push& push : pile.pushes) {
    const Index i = first_[push.body];
    if (i < 0) continue;
    load_.segment<3>(i) += push.force / unit_;
    load_.segment<3>(i + 3) += (push.at - pile.bodies[push.body].center).cross(push.force) / unit_;
  }
  load_ = load_.cwiseProduct(scale_);
  x_ = VectorXd::Zero(size);
  std::map<std::pair<Index, Index>, std::vector<std::size_t>> touching;  // contacts by pair of bodies
  for (std::size_t k = 0; k < pile.contacts.size(); ++k) {
    const Contact& c = pile.contacts[k];
    if (first_[c.a] >= 0 || first_[c.b] >= 0) touching[{first_[c.a], first_[c.b]}].push_back(k);
  }
  for (const auto& [key, contacts] : touching) {
    const auto [a, b] = key;
    // About the centre of a body that can move.
    const Contact& head = pile.contacts[contacts.front()];
    const Vec3 &center_a = pile.bodies[head.a].center, &center_b = pile.bodies[head.b].center;
    const Vec3 origin = a >= 0 ? center_a : center_b;
    const std::size_t first = points_.size();
    double area = 0, count = 0;
    for (const std::size_t k : contacts) {
      area += area_of(pile.contacts[k].points).norm();
      count += static_cast<double>(pile.contacts[k].points.size());
    }
    for (const std::size_t k : contacts) {
      const Contact& c = pile.contacts[k];
      const double corners = static_cast<double>(c.points.size());
      const double bed = law == FrictionLaw::associated || !(area > 0)
                             ? 1
                             : std::max(kLeastBed, area_of(c.points).norm() / area * count / corners);
      const double light = a < 0 ? share_[c.b] : b < 0 ? share_[c.a] : std::min(share_[c.a], share_[c.b]);
      for (std::size_t i = 0; i < c.points.size(); ++i)
        points_.push_back({k, i, c.points[i] - origin, c.normal, bed * light, c.friction,
                           std::numeric_limits<double>::infinity(), c.bonded});
    }
    pairs_.push_back({a, b, first, points_.size(), origin - center_a, origin - center_b});
  }
}

BlockMatrix Springs::pattern() const {
  BlockMatrix::Pairs pairs;
  for (const Pair& p : pairs_)
    if (p.a >= 0 && p.b >= 0) pairs.emplace_back(p.a / 6, p.b / 6);
  return {static_cast<std::size_t>(size() / 6), std::move(pairs)};
}

Springs::Vec6 Springs::relative(const Pair& pair, const VectorXd& x) const {
  Vec6 u = Vec6::Zero();
  const auto add = [&](Index i, const Vec3& arm, double sign) {
    const Vec3 w = x.segment<3>(i + 3) * (sign * scale_[i + 3]);
    u.head<3>() += x.segment<3>(i) * (sign * scale_[i]) + w.cross(arm);
    u.tail<3>() += w;
  };
  if (pair.a >= 0) add(pair.a, pair.arm_a, 1);
  if (pair.b >= 0) add(pair.b, pair.arm_b, -1);
  return u;
}

void Springs::add_wrench(const Pair& pair, const Vec6& on_a, VectorXd& forces) const {
  const auto add = [&](Index i, const Vec3& arm, double sign) {
    const Vec3 force = sign * on_a.head<3>();
    forces.segment<3>(i) += scale_[i] * force;
    forces.segment<3>(i + 3) += scale_[i + 3] * (sign * on_a.tail<3>() + arm.cross(force));
  };
  if (pair.a >= 0) add(pair.a, pair.arm_a, 1);
  if (pair.b >= 0) add(pair.b, pair.arm_b, -1);
}

Vec3 Springs::law_of(const Point& p, const Vec3& d, bool coupled, Mat3* resistance) const {
  if (p.bonded) return bonded_force(d, resistance);
  if (coupled) return coulomb_force(d, p.normal, p.friction, resistance);
  return law_ == FrictionLaw::associated ? associated_force(d, p.normal, p.friction, resistance)
                                         : limited_force(d, p.normal, p.limit, resistance);
}

double Springs::step_length(const VectorXd& anchor, const VectorXd& direction) const {
  std::vector<Vec3> from, displacement;
  each_point(x_, [&](const Pair&, std::size_t, const Vec3& d) { from.push_back(d); });
  each_point(direction, [&](const Pair&, std::size_t, const Vec3& d) { displacement.push_back(d); });
  const double constant = (proximal_ * (x_ - anchor) - load_).dot(direction),
               linear = proximal_ * direction.squaredNorm();
  const auto slope = [&](double t) {
    double sum = constant + t * linear;
    for (std::size_t k = 0; k < points_.size(); ++k)
      sum -= points_[k].stiffness * law_of(points_[k], from[k] + t * displacement[k]).dot(displacement[k]);
    return sum;
  };
  // The slope increases: a zero is enclosed, and the enclosure made smaller (Illinois).
  double low = 0, at_low = slope(0), high = 1, at_high = slope(1);
  const double enough = kLineShare * std::abs(at_low);
  if (std::abs(at_high) <= enough) return 1;
  for (int k = 0; k < kLineSteps && at_high < 0; ++k) {
    low = std::exchange(high, 2 * high);
    at_low = std::exchange(at_high, slope(high));
  }
  double t = high;
  for (int k = 0, side = 0; k < kLineSteps && at_low < 0 && at_high > 0; ++k) {
    t = (low * at_high - high * at_low) / (at_high - at_low);
    const double now = slope(t);
    if (std::abs(now) <= enough) break;
    if (now < 0) {
      if (side < 0) at_high *= 0.5;
      low = t;
      at_low = now;
      side = -1;
    } else {
      if (side > 0) at_low *= 0.5;
      high = t;
      at_high = now;
      side = 1;
    }
  }
  return t;
}

VectorXd Springs::derivatives(const VectorXd& anchor, bool coupled) {
  if (!hessian_) hessian_.emplace(pattern());
  VectorXd gradient = proximal_ * (x_ - anchor) - load_, forces = VectorXd::Zero(size());
  hessian_->set_zero();
  for (Block& b : hessian_->diagonal) b.diagonal().setConstant(coupled ? kProximalCoupled : proximal_);
  std::size_t next = 0;  // block of the matrix
  for (const Pair& pair : pairs_) {
    const std::size_t block = pair.a >= 0 && pair.b >= 0 ? next++ : 0;
    // A point r moves by v + w x r = [1, -R] (v, w): its block is [1, -R]' D [1, -R]. Rows of D R are cross products.
    const Vec6 u = relative(pair, x_);
    Vec6 wrench = Vec6::Zero();
    Block own = Block::Zero();
    bool pressed = false;
    for (std::size_t k = pair.first; k < pair.last; ++k) {
      const Point& p = points_[k];
      Mat3 d;
      const Vec3 force = p.stiffness * law_of(p, moved(p, u), coupled, &d);
      if (d.isZero(0) && force.isZero(0)) continue;
      pressed = true;
      d *= p.stiffness;
      wrench.head<3>() += force;
      wrench.tail<3>() += p.at.cross(force);
      Mat3 turned;  // D R
      for (Index i = 0; i < 3; ++i) turned.row(i) = d.row(i).cross(p.at.transpose());
      own.topLeftCorner<3, 3>() += d;
      own.topRightCorner<3, 3>() -= turned;
      for (Index i = 0; i < 3; ++i) own.block<3, 1>(3, i) += p.at.cross(d.col(i));
      for (Index i = 0; i < 3; ++i) own.block<3, 1>(3, 3 + i) -= p.at.cross(turned.col(i));
    }
    if (!pressed) continue;
    add_wrench(pair, wrench, forces);
    // Columns, then rows, for the coordinates of a body.
    const auto columns = [&](Index i, const Vec3& arm, const Block& m) {
      Block r = m;
      for (Index c = 0; c < 6; ++c) r.block<1, 3>(c, 3) += arm.cross(m.block<1, 3>(c, 0).transpose()).transpose();
      r.leftCols<3>() *= scale_[i];
      r.rightCols<3>() *= scale_[i + 3];
      return r;
    };
    const auto rows = [&](Index i, const Vec3& arm, const Block& m) -> Block {
      return columns(i, arm, m.transpose()).transpose();
    };
    Block by_a, by_b;
    if (pair.a >= 0) {
      by_a = columns(pair.a, pair.arm_a, own);
      hessian_->diagonal[static_cast<std::size_t>(pair.a / 6)] += rows(pair.a, pair.arm_a, by_a);
    }
    if (pair.b >= 0) {
      by_b = columns(pair.b, pair.arm_b, own);
      hessian_->diagonal[static_cast<std::size_t>(pair.b / 6)] += rows(pair.b, pair.arm_b, by_b);
    }
    if (pair.a < 0 || pair.b < 0) continue;
    hessian_->ab[block] = -rows(pair.a, pair.arm_a, by_b);
    if (coupled) hessian_->ba[block] = -rows(pair.b, pair.arm_b, by_a);
  }
  return gradient - forces;
}

void Springs::start_at(const VectorXd& x) {
  x_ = x;
  update_limits();
}

void Springs::lengthen_steps() { proximal_ = std::max(proximal_least_, 0.1 * proximal_); }

bool Springs::shorten_steps() {
  if (proximal_ >= kProximalMost) return false;
  proximal_ = std::min(kProximalMost, 10 * proximal_);
  return true;
}

bool Springs::minimize(const VectorXd& anchor, const std::function<bool()>& stop) {
  double steepest = std::numeric_limits<double>::infinity();
  for (int step = 0; step < kNewtonSteps; ++step) {
    if (stop && stop()) return false;
    const VectorXd gradient = derivatives(anchor, false);
    const double slope_now = gradient.norm() / load_.norm();
    if (slope_now <= 1e-10 || (slope_now <= 1e-7 && slope_now > 0.5 * steepest)) return true;  // or rounding
    steepest = std::min(steepest, slope_now);
    if (!factorize(true)) return false;
    const VectorXd direction = -factor_->solve(gradient);
    const double slope = gradient.dot(direction);
    if (!(slope < 0)) return slope_now <= 1e-7;
    x_ += step_length(anchor, direction) * direction;
  }
  return false;
}

double Springs::update_limits(double share) {
  double most = 0;
  each_point(x_, [&](const Pair&, std::size_t k, const Vec3& d) {
    Point& p = points_[k];
    if (p.bonded) return;
    const double limit = p.friction * std::max(0.0, -d.dot(p.normal));
    most = std::max(most, std::isfinite(p.limit) ? p.stiffness * std::abs(limit - p.limit) : 1);
    p.limit = std::isfinite(p.limit) ? p.limit + share * (limit - p.limit) : limit;
  });
  return most;
}

bool Springs::solve_coupled(const std::function<bool()>& stop) {
  const VectorXd start = x_;
  for (int step = 0; step < kCoupledSteps; ++step) {
    if (stop && stop()) break;
    const VectorXd anchor = x_;
    const VectorXd rest = derivatives(anchor, true);
    if (rest.norm() <= 1e-10 * load_.norm()) {
      update_limits();
      return true;
    }
    if (!factorize(false)) break;
    VectorXd direction = -factor_->solve(rest);
    direction -= factor_->solve(rest + hessian_->times(direction));  // what was lost without pivoting
    if (!direction.allFinite()) break;
    // Damping: the unbalanced rest has to become smaller.
    double t = 1;
    for (; t > 1e-3; t *= 0.5) {
      x_ = anchor + t * direction;
      if (unbalanced().norm() < (1 - 0.1 * t) * rest.norm()) break;
    }
    if (!(t > 1e-3)) break;
  }
  x_ = start;
  return false;
}

double Springs::work_done() { return work_of_thread; }

bool Springs::factorize(bool symmetric) {
  if (!factor_) factor_.emplace(*hessian_);
  ++factorizations_;
  work_of_thread += (symmetric ? 1 : 2) * factor_->work() + kPointWork * static_cast<double>(points_.size());
  return symmetric ? factor_->factorize_symmetric(*hessian_) : factor_->factorize(*hessian_);
}

VectorXd Springs::unbalanced() const {
  VectorXd forces = load_;
  each_point(x_, [&](const Pair& pair, std::size_t k, const Vec3& d) {
    const Vec3 f = points_[k].stiffness * law_of(points_[k], d, true);
    Vec6 wrench;
    wrench << f, points_[k].at.cross(f);
    add_wrench(pair, wrench, forces);
  });
  return -forces;
}

double Springs::residual(const VectorXd& anchor) const {
  double most = 0;
  const VectorXd rest = proximal_ * (x_ - anchor);
  for (std::size_t i = 0; i < first_.size(); ++i)
    if (first_[i] >= 0) most = std::max(most, rest.segment<6>(first_[i]).norm() / std::sqrt(share_[i]));
  return most;
}

Motions Springs::motion_of(const VectorXd& x) const {
  Motions motion(first_.size());
  for (std::size_t i = 0; i < first_.size(); ++i)
    if (first_[i] >= 0)
      motion[i] = {x.segment<3>(first_[i]) * scale_[first_[i]], x.segment<3>(first_[i] + 3) * scale_[first_[i] + 3]};
  return motion;
}

VectorXd Springs::point_of(const Motions& motion) const {
  VectorXd x(size());
  for (std::size_t i = 0; i < first_.size(); ++i)
    if (first_[i] >= 0) {
      x.segment<3>(first_[i]) = motion[i].v / scale_[first_[i]];
      x.segment<3>(first_[i] + 3) = motion[i].w / scale_[first_[i] + 3];
    }
  return x;
}

ContactForces Springs::forces() const {
  ContactForces forces;
  for (const Contact& c : pile_.contacts) forces.emplace_back(c.points.size(), Vec3::Zero());
  each_point(x_, [&](const Pair&, std::size_t k, const Vec3& d) {
    const Point& p = points_[k];
    forces[p.contact][p.index] = unit_ * p.stiffness * law_of(p, d);
  });
  return forces;
}

}  // namespace dismantle::statics
