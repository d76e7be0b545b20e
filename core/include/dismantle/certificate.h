/// Proof that parts cannot be separated, as data.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/pose.h"

namespace dismantle {

/// Claim: in no motion that begins at `poses`, and along which no two parts cut into each other by more than their
/// initial overlap and `margin`, does parts.front() come apart from the other parts while these keep their places
/// relative to each other. `numbers` is what the proof is made of, so that the prover of this kind can check it again.
struct Certificate {
  std::string kind;             ///< id of the prover that made it
  std::vector<PartId> parts;    ///< >= 2, distinct
  std::vector<Pose> poses;      ///< by place in `parts`; empty: as assembled
  bool full_tolerance = false;  ///< `margin` is all that the verifier allows: then no valid motion exists
  double margin = 0;            ///< assembly units, > 0; above the initial overlap of a pair
  std::map<std::string, std::vector<double>> numbers;  ///< by name; lengths and places in assembly units, angles in rad
  std::string text;                                    ///< one sentence for a reader; names of parts, input units
};

}  // namespace dismantle
