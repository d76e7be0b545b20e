#include "springs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace dismantle::statics {
namespace {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Eigen::Index;
using Eigen::VectorXd;

/// Weight of the proximal term against the stiffness of a contact. Small: few programs; large: well-conditioned ones.
constexpr double kProximal = 1e-4;
/// The same for Coulomb's law itself: only against exact singularity.
constexpr double kProximalCoupled = 1e-9;
constexpr int kNewtonSteps = 100, kCoupledSteps = 25;

Mat3 cross_matrix(const Vec3& r) {
  Mat3 m;
  m << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
  return m;
}

}  // namespace

Springs::Springs(const Pile& pile, FrictionLaw law) : pile_(pile), law_(law), unit_(0) {
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
  for (std::size_t k = 0; k < pile.contacts.size(); ++k) {
    const Contact& c = pile.contacts[k];
    const Index a = first_[c.a], b = first_[c.b];
    if (a < 0 && b < 0) continue;
    const double light = a < 0 ? share_[c.b] : b < 0 ? share_[c.a] : std::min(share_[c.a], share_[c.b]);
    for (const Vec3& at : c.points)
      points_.push_back({k, a, b, at - pile.bodies[c.a].center, at - pile.bodies[c.b].center, c.normal, light,
                         c.friction, std::numeric_limits<double>::infinity(), c.bonded});
  }
}

Vec3 Springs::moved(const Point& p, const VectorXd& x) const {
  Vec3 d = Vec3::Zero();
  const auto at = [&](Index i, const Vec3& r) -> Vec3 {
    const Vec3 v = x.segment<3>(i) * scale_[i], w = x.segment<3>(i + 3) * scale_[i + 3];
    return v + w.cross(r);
  };
  if (p.a >= 0) d += at(p.a, p.ra);
  if (p.b >= 0) d -= at(p.b, p.rb);
  return d;
}

PointForce Springs::law_of(const Point& p, const Vec3& d, bool coupled) const {
  if (p.bonded) return bonded_force(d);
  if (coupled) return coulomb_force(d, p.normal, p.friction);
  return law_ == FrictionLaw::associated ? associated_force(d, p.normal, p.friction)
                                         : limited_force(d, p.normal, p.limit);
}

double Springs::value(const VectorXd& x, const VectorXd& anchor) const {
  double sum = 0.5 * kProximal * (x - anchor).squaredNorm() - load_.dot(x);
  for (const Point& p : points_) sum += p.stiffness * law_of(p, moved(p, x)).energy;
  return sum;
}

VectorXd Springs::derivatives(const VectorXd& anchor, bool coupled, Eigen::SparseMatrix<double>& hessian) const {
  VectorXd gradient = kProximal * (x_ - anchor) - load_;
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(points_.size() * 78 + static_cast<std::size_t>(size()));
  for (Index i = 0; i < size(); ++i) entries.emplace_back(i, i, coupled ? kProximalCoupled : kProximal);
  using Block = Eigen::Matrix<double, 6, 6>;
  std::size_t next = 0;
  while (next < points_.size()) {
    // The points of one contact share their blocks. A point p moves by v + w x r; with the cross matrix R of r its
    // block is [1, -R]' D [1, -R]. The scales of the bodies come in the end.
    const Point& head = points_[next];
    Block aa = Block::Zero(), ab = Block::Zero(), ba = Block::Zero(), bb = Block::Zero();
    bool pressed = false;
    for (; next < points_.size() && points_[next].contact == head.contact; ++next) {
      const Point& p = points_[next];
      const PointForce f = law_of(p, moved(p, x_), coupled);
      if (f.resistance.isZero(0) && f.force.isZero(0)) continue;
      pressed = true;
      const Vec3 force = p.stiffness * f.force;
      const Mat3 d = p.stiffness * f.resistance;
      const auto pull = [&](Index i, const Vec3& r, const Vec3& on) {
        gradient.segment<3>(i) -= on * scale_[i];
        gradient.segment<3>(i + 3) -= r.cross(on) * scale_[i + 3];
      };
      const auto own = [&](Block& m, const Mat3& arm, const Mat3& turned) {  // turned = d arm
        m.topLeftCorner<3, 3>() += d;
        m.topRightCorner<3, 3>() -= turned;
        m.bottomLeftCorner<3, 3>() += arm * d;  // arm' = -arm
        m.bottomRightCorner<3, 3>() -= arm * turned;
      };
      const Mat3 arm_a = cross_matrix(p.ra), arm_b = cross_matrix(p.rb), turned_a = d * arm_a, turned_b = d * arm_b;
      if (p.a >= 0) {
        pull(p.a, p.ra, force);
        own(aa, arm_a, turned_a);
      }
      if (p.b >= 0) {
        pull(p.b, p.rb, -force);
        own(bb, arm_b, turned_b);
      }
      const auto other = [&](Block& m, const Mat3& arm, const Mat3& turned) {
        m.topLeftCorner<3, 3>() -= d;
        m.topRightCorner<3, 3>() += turned;
        m.bottomLeftCorner<3, 3>() -= arm * d;
        m.bottomRightCorner<3, 3>() += arm * turned;
      };
      if (p.a >= 0 && p.b >= 0) {
        other(ab, arm_a, turned_b);
        if (coupled) other(ba, arm_b, turned_a);
      }
    }
    // The pattern of the matrix does not depend on what presses.
    const auto scaled = [&](Index row, Index column, const Block& m) -> Block {
      return scale_.segment<6>(row).asDiagonal() * m * scale_.segment<6>(column).asDiagonal();
    };
    if (head.a >= 0 && pressed) aa = scaled(head.a, head.a, aa);
    if (head.b >= 0 && pressed) bb = scaled(head.b, head.b, bb);
    if (head.a >= 0 && head.b >= 0 && pressed) {
      ab = scaled(head.a, head.b, ab);
      ba = coupled ? scaled(head.b, head.a, ba) : Block(ab.transpose());
    }
    const auto add = [&](Index row, Index column, const Block& m) {
      for (Index r = 0; r < 6; ++r)
        for (Index c = 0; c < 6; ++c)
          if (coupled || row + r >= column + c) entries.emplace_back(row + r, column + c, m(r, c));
    };
    if (head.a >= 0) add(head.a, head.a, aa);
    if (head.b >= 0) add(head.b, head.b, bb);
    if (head.a >= 0 && head.b >= 0) {
      if (coupled || head.a > head.b) add(head.a, head.b, ab);
      if (coupled || head.a < head.b) add(head.b, head.a, ba);
    }
  }
  hessian.setFromTriplets(entries.begin(), entries.end());
  return gradient;
}

bool Springs::minimize(const VectorXd& anchor, const std::function<bool()>& stop) {
  Eigen::SparseMatrix<double> hessian(size(), size());
  double now = value(x_, anchor), steepest = std::numeric_limits<double>::infinity();
  for (int step = 0; step < kNewtonSteps; ++step) {
    if (stop && stop()) return false;
    const VectorXd gradient = derivatives(anchor, false, hessian);
    const double slope_now = gradient.norm() / load_.norm();
    if (slope_now <= 1e-10 || (slope_now <= 1e-7 && slope_now > 0.5 * steepest)) return true;  // or rounding
    steepest = std::min(steepest, slope_now);
    if (!analyzed_) factor_.analyzePattern(hessian);
    analyzed_ = true;
    factor_.factorize(hessian);
    ++factorizations_;
    if (factor_.info() != Eigen::Success) return false;
    const VectorXd direction = -factor_.solve(gradient);
    const double slope = gradient.dot(direction);
    if (!(slope < 0)) return slope_now <= 1e-7;
    double t = 1;
    VectorXd trial = x_ + direction;
    double then = value(trial, anchor);
    while (then > now + 1e-4 * t * slope && t > 1e-8) {
      t *= 0.5;
      trial = x_ + t * direction;
      then = value(trial, anchor);
    }
    if (!(then <= now)) return slope_now <= 1e-7;
    x_ = trial;
    now = then;
  }
  return false;
}

double Springs::update_limits(double share) {
  double most = 0;
  for (Point& p : points_) {
    if (p.bonded) continue;
    const double limit = p.friction * std::max(0.0, -moved(p, x_).dot(p.normal));
    most = std::max(most, std::isfinite(p.limit) ? p.stiffness * std::abs(limit - p.limit) : 1);
    p.limit = std::isfinite(p.limit) ? p.limit + share * (limit - p.limit) : limit;
  }
  return most;
}

bool Springs::solve_coupled(const std::function<bool()>& stop) {
  const VectorXd start = x_;
  Eigen::SparseMatrix<double> jacobian(size(), size());
  for (int step = 0; step < kCoupledSteps; ++step) {
    if (stop && stop()) break;
    const VectorXd anchor = x_;
    const VectorXd rest = derivatives(anchor, true, jacobian);
    if (rest.norm() <= 1e-10 * load_.norm()) {
      update_limits();
      return true;
    }
    jacobian.makeCompressed();
    if (!analyzed_coupled_) coupled_.analyzePattern(jacobian);
    analyzed_coupled_ = true;
    coupled_.factorize(jacobian);
    ++factorizations_;
    if (coupled_.info() != Eigen::Success) break;
    const VectorXd direction = -coupled_.solve(rest);
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

VectorXd Springs::unbalanced() const {
  VectorXd rest = -load_;
  for (const Point& p : points_) {
    const Vec3 f = p.stiffness * law_of(p, moved(p, x_), true).force;
    const auto add = [&](Index i, const Vec3& r, const Vec3& force) {
      rest.segment<3>(i) -= force.cwiseProduct(scale_.segment<3>(i));
      rest.segment<3>(i + 3) -= r.cross(force).cwiseProduct(scale_.segment<3>(i + 3));
    };
    if (p.a >= 0) add(p.a, p.ra, f);
    if (p.b >= 0) add(p.b, p.rb, -f);
  }
  return rest;
}

double Springs::residual(const VectorXd& anchor) const {
  double most = 0;
  const VectorXd rest = kProximal * (x_ - anchor);
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

ContactForces Springs::forces() const {
  ContactForces forces;
  for (const Contact& c : pile_.contacts) forces.emplace_back(c.points.size(), Vec3::Zero());
  std::vector<std::size_t> next(forces.size(), 0);
  for (const Point& p : points_)
    forces[p.contact][next[p.contact]++] = unit_ * p.stiffness * law_of(p, moved(p, x_)).force;
  return forces;
}

}  // namespace dismantle::statics
