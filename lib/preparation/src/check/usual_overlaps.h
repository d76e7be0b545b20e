/// Overlaps that usual models of fits have.
#pragma once

#include <map>

#include "dismantle/preparation/check_assembly.h"
#include "dismantle/verification/contact.h"

namespace dismantle {

/// Finds the overlaps that are usual.
class UsualOverlaps {
 public:
  /// `assembly` must outlive this.
  explicit UsualOverlaps(const Assembly& assembly) : assembly_(assembly) {}

  /// Makes `finding`, an overlap, a note if it is that of a screw without a thread, or slight for the size of the
  /// parts.
  void excuse(const InitialOverlap& pair, const PairContact& found, Finding& finding);

 private:
  /// Of the oriented box, so that it does not depend on how the part is turned; assembly units.
  double smallest_extent(PartId part);

  const Assembly& assembly_;
  std::map<PartId, double> extents_;
};

/// One line for findings that are alike: how many pairs, how deep at most.
std::string together_text(const std::vector<const Finding*>& findings);

}  // namespace dismantle
