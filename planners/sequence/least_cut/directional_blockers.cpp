#include "least_cut/directional_blockers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "dismantle/geometry/boxes_along.h"
#include "dismantle/geometry/swept_boxes.h"
#include "dismantle/part_set.h"

namespace dismantle::least_cut {

std::array<int, 3> rounded_direction(const Eigen::Vector3d& d) {
  const Eigen::Vector3d steps = 1e6 * d;  // directions of the same face differ by rounding only
  return {static_cast<int>(std::lround(steps.x())), static_cast<int>(std::lround(steps.y())),
          static_cast<int>(std::lround(steps.z()))};
}

DirectionalBlockers::DirectionalBlockers(std::vector<Aabb> boxes, Reach reach, Thickness thickness)
    : boxes_(std::move(boxes)),
      reach_(std::move(reach)),
      thickness_(std::move(thickness)),
      list_id_(boxes_.size(), 0),
      pose_(boxes_.size()),
      placed_box_(boxes_.size()),
      present_(boxes_.size(), false) {}

void DirectionalBlockers::set_group(const Placed& group) {
  group_ = &group;
  std::fill(present_.begin(), present_.end(), false);
  bool known = true;
  for (const PlacedPart& p : group) {
    present_[p.part] = true;
    known =
        known && list_id_[p.part] != 0 && list_id_[p.part] == list_id_[group.front().part] && pose_[p.part] == p.pose;
  }
  if (known) return;
  ++last_list_id_;
  for (const PlacedPart& p : group) {
    list_id_[p.part] = last_list_id_;
    pose_[p.part] = p.pose;
    placed_box_[p.part] = geometry::box_under(boxes_[p.part], p.pose);
    for (Row& row : rows_) row.of[p.part] = {};
  }
}

DirectionalBlockers::Entry& DirectionalBlockers::measured(Row& row, const PlacedPart& part) {
  Entry& entry = row.of[part.part];
  if (entry.measured) return entry;
  entry.ahead = reach_(part, row.direction);
  entry.behind = reach_(part, -row.direction);
  entry.measured = true;
  return entry;
}

const std::vector<DirectionalBlockers::Blocker>& DirectionalBlockers::blockers(Row& row, const PlacedPart& part) {
  Entry& entry = measured(row, part);
  if (entry.listed) return entry.blockers;
  for (const PlacedPart& q : *group_) {
    if (q.part == part.part || !geometry::meets_along(placed_box_[part.part], placed_box_[q.part], row.direction))
      continue;
    if (const double t = thickness_(part, q, row.direction); t > 0) entry.blockers.push_back({q.part, t});
  }
  entry.listed = true;
  return entry.blockers;
}

DirectionalBlockers::Along::Along(DirectionalBlockers& all, const Eigen::Vector3d& direction)
    : all_(all), row_(0), furthest_(-std::numeric_limits<double>::infinity()), second_(furthest_) {
  auto& rows = all.rows_;
  while (row_ < rows.size() && !(rounded_direction(rows[row_].direction) == rounded_direction(direction))) ++row_;
  if (row_ == rows.size()) rows.push_back({direction, std::vector<Entry>(all.boxes_.size())});
  for (const PlacedPart& p : *all.group_) {
    const double ahead = all.measured(rows[row_], p).ahead;
    second_ = std::max(second_, std::min(ahead, furthest_));
    if (ahead > furthest_) {
      furthest_ = ahead;
      front_ = p.part;
    }
  }
}

double DirectionalBlockers::Along::thickness(const Placed& unit) const {
  double sum = 0;
  for (const PlacedPart& p : unit)
    for (const Blocker& q : all_.blockers(all_.rows_[row_], p))
      if (all_.present_[q.part] && !contains(unit, q.part)) sum += q.thickness;
  return sum;
}

double DirectionalBlockers::Along::length(const Placed& unit) const {
  Row& row = all_.rows_[row_];
  double ahead = contains(unit, front_) ? second_ : furthest_, behind = -std::numeric_limits<double>::infinity();
  for (const PlacedPart& p : unit) behind = std::max(behind, all_.measured(row, p).behind);
  if (unit.size() > 1 && contains(unit, front_)) {  // the second one may be in the unit, too
    ahead = -std::numeric_limits<double>::infinity();
    for (const PlacedPart& p : *all_.group_)
      if (!contains(unit, p.part)) ahead = std::max(ahead, all_.measured(row, p).ahead);
  }
  return std::max(0.0, ahead + behind);
}

}  // namespace dismantle::least_cut
