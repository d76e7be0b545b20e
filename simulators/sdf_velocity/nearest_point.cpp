#include "nearest_point.h"

#include <algorithm>
#include <limits>

#include "dismantle/geometry/numerics.h"

namespace dismantle::sdf_velocity {
void NearestPoint::reset(Eigen::Index dimensions) {
  count_ = 0;
  if (dimensions == dimensions_) return;
  dimensions_ = dimensions;
  normals_.resize(dimensions, 64);
  offsets_.resize(64);
  basis_.resize(dimensions, dimensions);
  triangle_.resize(dimensions, dimensions);
}

Eigen::Index NearestPoint::add() {
  if (count_ == normals_.cols()) {
    normals_.conservativeResize(Eigen::NoChange, 2 * count_);
    offsets_.conservativeResize(2 * count_);
  }
  normals_.col(count_).setZero();
  offsets_[count_] = 0;
  return count_++;
}

/// Splits the next active normal into basis * along + rest.
void NearestPoint::append(const Eigen::VectorXd& along, const Eigen::VectorXd& rest, double length) {
  const auto q = along.size();
  basis_.col(q) = rest / length;
  triangle_.col(q).head(q) = along;
  triangle_(q, q) = length;
}

void NearestPoint::drop(std::size_t k) {
  const auto at = static_cast<std::ptrdiff_t>(k);
  active_.erase(active_.begin() + at);
  forces_.erase(forces_.begin() + at);
  // The matrices are small: recomputing them avoids accumulated errors.
  Eigen::VectorXd along, rest;
  for (auto q = static_cast<Eigen::Index>(k); q < static_cast<Eigen::Index>(active_.size()); ++q) {
    const auto a = normals_.col(active_[static_cast<std::size_t>(q)]);
    const auto known = basis_.leftCols(q);
    along = known.transpose() * a;
    rest = a - known * along;
    const Eigen::VectorXd again = known.transpose() * rest;  // second orthogonalisation, against rounding
    rest -= known * again;
    along += again;
    append(along, rest, rest.norm());
  }
}

NearestPoint::Outcome NearestPoint::solve(const Eigen::VectorXd& target, Eigen::VectorXd& y) {
  y = target;
  active_.clear();
  forces_.clear();
  const int most = 100 + 20 * static_cast<int>(dimensions_);
  for (iterations_ = 0; iterations_ < most;) {
    Eigen::Index worst = 0;
    if (count_ == 0) return Outcome::solved;
    violation_.noalias() = offsets_.head(count_) - normals_.leftCols(count_).transpose() * y;
    if (violation_.maxCoeff(&worst) <= geometry::kRounding) return Outcome::solved;
    const auto a = normals_.col(worst);
    double force = 0;
    for (bool added = false; !added && iterations_ < most; ++iterations_) {
      const auto q = static_cast<Eigen::Index>(active_.size());
      const auto known = basis_.leftCols(q);
      along_ = known.transpose() * a;
      rest_ = a - known * along_;
      change_ = known.transpose() * rest_;
      rest_ -= known * change_;
      along_ += change_;
      change_ = triangle_.topLeftCorner(q, q).template triangularView<Eigen::Upper>().solve(along_);
      const double length = rest_.norm();
      // Step lengths until the violation is zero, and until an active constraint's multiplier is zero.
      const double full = length > geometry::kRounding ? (offsets_[worst] - a.dot(y)) / (length * length)
                                                       : std::numeric_limits<double>::infinity();
      double partial = std::numeric_limits<double>::infinity();
      std::size_t leaves = 0;
      for (Eigen::Index k = 0; k < q; ++k) {
        if (change_[k] <= 1e-12) continue;
        const double t = forces_[static_cast<std::size_t>(k)] / change_[k];
        if (t < partial) partial = t, leaves = static_cast<std::size_t>(k);
      }
      const double t = std::max(0.0, std::min(full, partial));
      if (t == std::numeric_limits<double>::infinity()) return Outcome::infeasible;
      if (length > geometry::kRounding) y += t * rest_;
      for (Eigen::Index k = 0; k < q; ++k) {
        double& f = forces_[static_cast<std::size_t>(k)];
        f = std::max(0.0, f - t * change_[k]);
      }
      force += t;
      if (full <= partial) {
        append(along_, rest_, length);
        active_.push_back(worst);
        forces_.push_back(force);
        added = true;
      } else {
        drop(leaves);
      }
    }
  }
  return Outcome::unfinished;
}

}  // namespace dismantle::sdf_velocity
