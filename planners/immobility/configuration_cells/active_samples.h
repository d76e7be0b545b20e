/// The active set: the few samples that bound the motion of two parts, added where the decomposition needs them.
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "configuration_cells/pose_cell.h"
#include "dismantle/immobility/interior_samples.h"

namespace dismantle::immobility {

/// Samples that may be inside their obstacle somewhere in a cell. Its halves inherit them.
struct NearSamples {
  std::shared_ptr<const SampleList> samples;
  /// The displacement within the cell for which the other samples were left out; assembly units.
  double reach = std::numeric_limits<double>::infinity();
};

class ActiveSamples {
 public:
  /// `tolerance`: is_free() of a segment checks poses less than half of it apart; assembly units.
  ActiveSamples(const SampledPair& pair, SampleList initial, double tolerance);

  const SampleList& list() const { return list_; }
  /// All samples, for a cell without further information.
  const NearSamples& all() const { return all_; }
  /// Activates the sample that is deepest inside its obstacle at the centre of the cell, if any is inside. Updates
  /// `near`.
  void activate_deepest(const PoseCell& cell, NearSamples& near);
  /// True if no sample is inside, active or not. The samples of the cell around the pose are tested first.
  bool is_free(const Vector6& x, const PoseCell& around) const;
  /// True if no active sample is inside along the segment between two poses. Checks discrete poses, so this is no
  /// proof.
  bool is_free(const Vector6& from, const Vector6& to) const;

 private:
  void update(const PoseCell& cell, const RelativePose& pose, NearSamples& near) const;

  const SampledPair& pair_;
  SampleList list_;
  std::vector<bool> active_;  ///< by sample
  NearSamples all_;
  double step_;
};

}  // namespace dismantle::immobility
