/// Proof that parts cannot be separated, as data.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/pose.h"

namespace dismantle {

/// Claim: no motion separates parts.front() from the other parts if it begins at `poses`, keeps the other parts fixed
/// relative to each other, and lets no two parts penetrate by more than their initial overlap plus `margin`. `numbers`
/// holds the data from which a prover of this kind can check the proof again.
struct Certificate {
  std::string kind;             ///< id of the prover that made it
  std::vector<PartId> parts;    ///< >= 2, distinct
  std::vector<Pose> poses;      ///< in the order of `parts`; empty: as assembled
  bool full_tolerance = false;  ///< `margin` is the verifier's whole tolerance, so no valid motion exists
  double margin = 0;            ///< assembly units, > 0; added to the initial overlap of a pair
  std::map<std::string, std::vector<double>> numbers;  ///< by name; lengths and places in assembly units, angles in rad
  std::string text;                                    ///< one sentence for a reader; names of parts, input units
};

}  // namespace dismantle
