/// Results of checks that took long, to be found again.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/pose.h"

namespace dismantle {

/// A search shows its path to the verifier, the oracle checks it, and a planner of orders asks once more: it is the
/// same motion of the same pair. A check depends on nothing but its key, so that what is remembered is what would be
/// found, in whichever order threads ask.
template <class Result>
class PairMemory {
 public:
  struct Key {
    PartId a = 0, b = 0;
    std::size_t rung = 0;  ///< at which the check began
    const std::vector<Pose>*poses_a = nullptr, *poses_b = nullptr;
  };

  std::optional<Result> find(const Key& key) const {
    const std::lock_guard lock(mutex_);
    const auto of_pair = entries_.find({key.a, key.b});
    if (of_pair == entries_.end()) return std::nullopt;
    for (const Entry& e : of_pair->second)
      if (e.rung == key.rung && e.poses_a == *key.poses_a && e.poses_b == *key.poses_b) return e.result;
    return std::nullopt;
  }

  void add(const Key& key, const Result& result) {
    const std::lock_guard lock(mutex_);
    if (count_ == kMost) {
      entries_.clear();
      count_ = 0;
    }
    entries_[{key.a, key.b}].push_back({key.rung, *key.poses_a, *key.poses_b, result});
    ++count_;
  }

 private:
  static constexpr std::size_t kMost = 256;  // each of them took some 10 ms or more, and holds a path
  struct Entry {
    std::size_t rung = 0;
    std::vector<Pose> poses_a, poses_b;
    Result result;
  };
  mutable std::mutex mutex_;
  std::map<std::pair<PartId, PartId>, std::vector<Entry>> entries_;
  std::size_t count_ = 0;
};

}  // namespace dismantle
