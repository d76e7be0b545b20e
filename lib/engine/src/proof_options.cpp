#include "dismantle/engine/proof_options.h"

namespace dismantle {

void ProofOptions::describe(Schema<ProofOptions>& s) {
  s.advanced("low_effort_depth", &ProofOptions::low_effort_depth, {1});
  s.advanced("medium_effort_depth", &ProofOptions::medium_effort_depth, {1});
  s.advanced("low_effort_steps", &ProofOptions::low_effort_steps, {1, 1e12});
  s.advanced("medium_effort_steps", &ProofOptions::medium_effort_steps, {1, 1e12});
  s.advanced("high_effort_steps", &ProofOptions::high_effort_steps, {1, 1e12});
  s.advanced("reduced_tolerance", &ProofOptions::reduced_tolerance, {0.05, 1});
  s.advanced("final_parts", &ProofOptions::final_parts, {0});
  s.advanced("deadline_share", &ProofOptions::deadline_share, {0.01, 1});
}

}  // namespace dismantle
