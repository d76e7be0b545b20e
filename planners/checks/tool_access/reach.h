/// How a tool reaches a fastener, for the judge of a step.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "dismantle/tools/access.h"
#include "dismantle/tools/catalogue.h"
#include "fastener_memo.h"

namespace dismantle::checks {

/// A tool in its place, or the best one that has none.
struct Reach {
  const tools::Tool* tool = nullptr;  // null: none of the catalogue fits
  tools::Access access;
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  Eigen::Vector3d at = Eigen::Vector3d::Zero();    // top of the fastener, input units
  Eigen::Vector3d seat = Eigen::Vector3d::Zero();  // origin of the tool's volumes, input units
  tools::Fastener fastener{};                      // as assembled
  bool flipped = false;
  std::size_t place = 0;  // number of the use in the catalogue
  bool reaches() const { return tool != nullptr && access.reaches(); }
};

inline void keep_better(Reach& best, Reach&& found) {
  if (best.tool == nullptr || found.access.obstacles.size() < best.access.obstacles.size()) best = std::move(found);
}
inline bool is_in(PartId part, std::span<const PlacedPart> list) {
  return std::any_of(list.begin(), list.end(), [&](const PlacedPart& p) { return p.part == part; });
}

/// What is turned, and what must not turn with it.
struct Task {
  const Driven* turned = nullptr;
  const Driven* held = nullptr;     // null: it needs no second tool
  std::optional<PartId> partner{};  // what it is driven into, or onto
  std::optional<PartId> kept_by{};  // a part in which the other one cannot turn
  bool hold_unknown = false;        // the drive of the other one is not recognised
};

struct Answer {
  Task task;
  Reach turning, holding;
  std::vector<Reach> one_obstacle{};  // uses of tools that a single part keeps from turning it
  bool reaches() const { return turning.reaches() && (task.held == nullptr || holding.reaches()); }
};

inline bool is_turned(const Driven& d) {
  return d.fastener.kind == fasteners::Kind::screw || d.fastener.kind == fasteners::Kind::nut;
}
inline bool has_drive(const Driven& d) {
  return !is_turned(d) || (d.fastener.drive != fasteners::Drive::none && d.fastener.size > 0);
}
inline bool has_size(const Driven& d) {
  return d.fastener.kind == fasteners::Kind::ring || (!d.size.empty() && d.size.front() != '?');
}

}  // namespace dismantle::checks
