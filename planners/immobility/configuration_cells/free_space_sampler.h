/// A random tree of free relative poses of two parts: how far they can move, and which samples block them.
#pragma once

#include <array>
#include <cstddef>
#include <set>
#include <vector>

#include "configuration_cells/pose_cell.h"
#include "dismantle/immobility/interior_samples.h"
#include "dismantle/run_context.h"

namespace dismantle::immobility {

/// Grows a tree of poses from the assembled one. It proves nothing: it does not check between poses, and it may miss a
/// way out.
class FreeSpaceSampler {
 public:
  /// Parts whose shift exceeds `separated` count as separated. The first steps are shorter than `tolerance`; assembly
  /// units.
  FreeSpaceSampler(const SampledPair& pair, double separated, double tolerance);

  /// Makes `checks` state checks in all directions.
  void explore(std::size_t checks, const RunContext& context);
  /// Makes up to `checks` state checks towards a pose and beyond it.
  void extend_towards(const Vector6& to, std::size_t checks, const RunContext& context);
  /// Adds a pose that is known to be free from elsewhere.
  void add(const Vector6& pose);

  bool separated() const { return is_separated_; }
  const Vector6& lo() const { return lo_; }  ///< bounds of the poses of the tree
  const Vector6& hi() const { return hi_; }
  /// The pose of the tree that is turned furthest.
  const Vector6& furthest_turn() const { return poses_[furthest_turn_]; }
  /// Samples that blocked an extension, ascending.
  SampleList blocking() const { return {blocking_.begin(), blocking_.end()}; }

 private:
  bool is_free(const Vector6& x);
  Vector6 random_direction();
  Vector6 random_difference();
  double dot(const Vector6& x, const Vector6& y) const;  ///< in assembly units, squared
  double length(const Vector6& x) const;
  std::vector<std::size_t> nearest(const Vector6& to) const;
  std::size_t extend_ray(std::size_t from, const Vector6& step);
  void slide_towards(std::size_t from, const Vector6& direction, std::size_t until);

  const SampledPair& pair_;
  double separated_, stride_;
  Rng rng_{7};
  bool is_separated_ = false;
  Vector6 lo_ = Vector6::Zero(), hi_ = Vector6::Zero();
  std::vector<std::uint32_t> order_;     ///< samples, the last one that blocked first
  std::vector<std::uint32_t> by_place_;  ///< samples: neighbours are near each other
  std::vector<Vector6> poses_;
  std::array<std::size_t, 12> furthest_{};  ///< poses with the least and the largest value of each coordinate
  std::size_t furthest_turn_ = 0;
  std::set<std::uint32_t> blocking_;
  std::size_t checks_ = 0;
};

}  // namespace dismantle::immobility
