/// States seen so far, and whether a new one is similar to any of them (section 4.2).
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "dismantle/path/path_thinning.h"
#include "dismantle/simulator.h"

namespace dismantle::path {

/// Two states are similar if every body's centre is nearer than `translation` (assembly units) and every
/// body's orientation closer than `rotation` (rad, geodesic). Hashed by the first body's cell.
class StateSet {
 public:
  StateSet(std::vector<Ball> bodies, double translation, double rotation);

  void add(const State& state, std::uint32_t label);
  void clear();
  /// True if a similar state has a label outside [ignore_first, ignore_last). A run ignores its own labels in this way.
  bool has_similar(const State& state, std::uint32_t ignore_first = 0, std::uint32_t ignore_last = 0) const;
  std::size_t count_similar(const State& state) const;
  bool similar(const State& a, const State& b) const;
  std::size_t size() const { return entries_.size(); }

 private:
  struct Entry {
    std::vector<Eigen::Vector3d> centers;
    std::vector<Eigen::Quaterniond> turns;
    std::uint32_t label;
  };
  using Key = std::uint64_t;
  Key key(const Eigen::Vector3d& center, int dx, int dy, int dz) const;
  Entry entry(const State& state, std::uint32_t label) const;
  bool close(const Entry& a, const Entry& b) const;
  /// Calls f(entry) for similar entries until it returns false.
  template <class F>
  void near(const Entry& probe, const F& f) const;

  std::vector<Ball> bodies_;
  double translation_, rotation_;
  std::vector<Entry> entries_;
  std::unordered_map<Key, std::vector<std::uint32_t>> cells_;
};

}  // namespace dismantle::path
