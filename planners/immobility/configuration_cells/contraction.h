/// Record of the contraction of a cell, for checking: the moved faces, and the half spaces that moved them.
#pragma once

#include <cstdint>
#include <vector>

namespace dismantle::immobility {

/// A half space of a sample (HalfSpace::source), and its multiplier in the sum that bounds a coordinate.
struct Reason {
  std::uint32_t sample = 0, source = 0;
  double multiplier = 0;
};

struct FaceMove {
  static constexpr int kEmpty = 12;  ///< no face: the half spaces have no common point in the cell
  int face = kEmpty;                 ///< 2 k or 2 k + 1: the lower or the upper one of coordinate k
  double to = 0;                     ///< new coordinate of the face; unused for kEmpty
  std::vector<Reason> reasons;
};

/// By round. The half spaces are those of the cell at the beginning of the round.
using Contraction = std::vector<std::vector<FaceMove>>;

}  // namespace dismantle::immobility
