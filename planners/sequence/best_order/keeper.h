/// The removals of the planner inside, passed on and kept.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/sequence_planner.h"

namespace dismantle::order {

/// Passes removals on, and keeps them.
class Keeper final : public SequenceObserver {
 public:
  Keeper(SequenceObserver& observer, std::string planner) : observer_(observer), planner_(std::move(planner)) {}
  void removed(const Removal& removal, std::size_t parts_left) override {
    Removal named = removal;
    if (named.planner.empty()) named.planner = planner_;
    observer_.removed(named, parts_left);
    all.emplace_back(std::move(named), parts_left);
  }
  bool taken_back(std::size_t count) override {
    if (count > all.size() || !observer_.taken_back(count)) return false;
    all.resize(all.size() - count);
    return true;
  }
  std::vector<Removal> removals() const {
    std::vector<Removal> out;
    for (const auto& [removal, left] : all) out.push_back(removal);
    return out;
  }
  std::vector<std::pair<Removal, std::size_t>> all;

 private:
  SequenceObserver& observer_;
  std::string planner_;  // of removals that name none
};

}  // namespace dismantle::order
