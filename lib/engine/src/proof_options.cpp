#include "dismantle/engine/proof_options.h"

namespace dismantle {

void ProofOptions::describe(Schema<ProofOptions>& s) {
  s.add(
      "low_effort_depth", &ProofOptions::low_effort_depth,
      {.unit = "1",
       .min = 1,
       .doc =
           "Advanced. Cheap proofs are tried for searches of at least this depth, and for searches without a limit."});
  s.add("medium_effort_depth", &ProofOptions::medium_effort_depth,
        {.unit = "1",
         .min = 1,
         .doc = "Advanced. Expensive proofs about one part against one other are tried for searches of at least this "
                "depth, and for searches without a limit."});
  s.add("low_effort_steps", &ProofOptions::low_effort_steps,
        {.unit = "1",
         .min = 1,
         .max = 1e12,
         .doc = "Advanced. Steps and state checks that a search spends before cheap proofs are tried; about the cost "
                "of these proofs. If the search ends earlier without a path, they are tried then."});
  s.add("medium_effort_steps", &ProofOptions::medium_effort_steps,
        {.unit = "1", .min = 1, .max = 1e12, .doc = "Advanced. As low_effort_steps, for expensive proofs."});
  s.add("reduced_tolerance", &ProofOptions::reduced_tolerance,
        {.unit = "1",
         .min = 0.05,
         .max = 1,
         .doc = "Advanced. Share of the tolerance for which the last proofs are tried first. With a smaller tolerance "
                "more can be proved, but the proof covers fewer motions."});
  s.add("final_parts", &ProofOptions::final_parts,
        {.unit = "1",
         .min = 0,
         .doc = "Advanced. Maximum number of parts for which proofs are tried at the end of a run, up to a minute "
                "each. 0 = none."});
  s.add("deadline_share", &ProofOptions::deadline_share,
        {.unit = "1",
         .min = 0.01,
         .max = 1,
         .doc = "Advanced. Share of the time left until the deadline that one of the most expensive proofs may take. "
                "Without a deadline they are limited by counts only."});
}

}  // namespace dismantle
