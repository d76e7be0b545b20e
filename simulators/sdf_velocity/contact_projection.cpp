#include "contact_projection.h"

#include <algorithm>
#include <cmath>

#include "dismantle/geometry/numerics.h"

namespace dismantle::sdf_velocity {
/// Chooses for each contact the face that `x` enters least.
void ContactProjection::choose(const std::vector<sdf::ContactRow>& rows, int per_body, const Vector& x) {
  for (Group& g : groups_) {
    bool any = false;
    double best = 0;
    for (std::size_t k = g.first; k < g.first + g.count; ++k) {
      if (rows[k].gap < g.least) continue;
      const double gap = rows[k].gap_at(x, per_body);
      if (any && gap <= best) continue;
      any = true;
      best = gap;
      g.chosen = k;
    }
  }
}

/// Each contact that constrains the solution x switches to the face `turn` places further on if x lies on or outside
/// it, so x stays feasible. False if no contact can switch.
bool ContactProjection::exchange(const std::vector<sdf::ContactRow>& rows, int per_body, const Vector& x,
                                 std::size_t turn) {
  bool any = false;
  for (const Eigen::Index i : holding_) {
    Group& g = groups_[static_cast<std::size_t>(i)];
    if (turn >= g.count) continue;
    const std::size_t other = g.first + (g.chosen - g.first + turn) % g.count;
    if (rows[other].gap < g.least || rows[other].gap_at(x, per_body) < -geometry::kRounding) continue;
    g.chosen = other;
    any = true;
  }
  return any;
}

bool ContactProjection::solve(const std::vector<sdf::ContactRow>& rows, int per_body, Below below, const Vector& wanted,
                              Vector& x) {
  nearest_.reset(wanted.size());
  for (const Group& g : groups_) {
    const sdf::ContactRow& row = rows[g.chosen];
    const auto i = nearest_.add();
    auto normal = nearest_.normal(i);
    if (row.first >= 0) normal.segment(row.first, per_body) = row.j_first.head(per_body);
    if (row.second >= 0) normal.segment(row.second, per_body) = row.j_second.head(per_body);
    normal.array() /= scale_.array();
    const double length = normal.norm();
    normal /= length;
    double least = -row.gap;
    if (row.gap < 0) least = below == Below::lift ? std::min(least, most_lift_) : 0.0;
    nearest_.offset(i) = least / length;
  }
  target_ = wanted.cwiseProduct(scale_);
  if (nearest_.solve(target_, y_) != NearestPoint::Outcome::solved) return false;
  // A lift that deviates from the wanted motion by more than four times the depth means that the body is blocked.
  if (below == Below::lift && (y_ - target_).norm() > target_.norm() + 4 * deepest_ + geometry::kRounding) return false;
  x = y_.cwiseQuotient(scale_);
  return true;
}

void ContactProjection::project(const std::vector<sdf::ContactRow>& rows, int per_body,
                                const std::vector<double>& radii, const Vector& wanted, Vector& x) {
  scale_.resize(wanted.size());
  for (Eigen::Index k = 0; k < wanted.size(); ++k)
    scale_[k] = k % per_body < 3 ? 1.0 : radii[static_cast<std::size_t>(k / per_body)];
  groups_.clear();
  deepest_ = 0;
  std::size_t most = 1;
  for (std::size_t i = 0; i < rows.size();) {
    const auto count = 1 + static_cast<std::size_t>(rows[i].alternatives);
    double gap = rows[i].gap;
    for (std::size_t k = 1; k < count; ++k) gap = std::max(gap, rows[i + k].gap);
    groups_.push_back({i, count, i, std::min(gap, -behind_)});
    deepest_ = std::max(deepest_, -gap);
    most = std::max(most, count);
    i += count;
  }
  const Vector nothing = Vector::Zero(wanted.size());
  choose(rows, per_body, wanted);
  bool found = solve(rows, per_body, Below::lift, wanted, x);
  if (!found) {
    choose(rows, per_body, nothing);
    found = solve(rows, per_body, Below::lift, wanted, x) || solve(rows, per_body, Below::hold, wanted, x);
  }
  if (!found) {
    x = nothing;
    return;
  }
  const auto cost = [&](const Vector& at) { return (at - wanted).cwiseProduct(scale_).squaredNorm(); };
  Vector better(wanted.size());
  std::size_t turn = 1;
  holding_ = nearest_.active();
  for (int round = 0; turn < most && round < 24; ++round) {  // a few rounds are usual; the limit stops cycles
    const std::vector<Group> before = groups_;
    if (exchange(rows, per_body, x, turn) && solve(rows, per_body, Below::lift, wanted, better) &&
        cost(better) < cost(x) * (1 - geometry::kRounding)) {
      x = better;
      holding_ = nearest_.active();
      turn = 1;
      continue;
    }
    groups_ = before;
    ++turn;
  }
}

}  // namespace dismantle::sdf_velocity
