/// Removals by force: measures how deep a motion cuts in, and states why no verified path is known.
#pragma once

#include "dismantle/engine/proof_options.h"
#include "dismantle/part_set.h"
#include "dismantle/path_oracle.h"
#include "dismantle/verification/motion_depth.h"
#include "path_normalizer.h"
#include "reasons.h"

namespace dismantle {

class Oracle;

class Forcing final : public ForcingOracle {
 public:
  /// All references must outlive this.
  Forcing(const Assembly& assembly, const Verifier& verifier, Oracle& oracle, const ProofOptions& proofs)
      : assembly_(assembly),
        verifier_(verifier),
        oracle_(oracle),
        proofs_(proofs),
        normalizer_(assembly),
        meter_(assembly, verifier) {}

  std::optional<MotionDepth> depth(const std::vector<PartId>& moving, const std::vector<PlacedPart>& fixed,
                                   const Path& path, const MotionDepthOptions& options,
                                   const RunContext& context) override;
  void prove_left(std::vector<Unsolved>& unsolved, const std::vector<std::vector<PlacedPart>>& groups,
                  const RunContext& context) override;
  const AttemptResult& propose_forced(const Attempt& attempt, const Path& path, const std::optional<MotionDepth>& known,
                                      std::span<const Unsolved> said, RunContext& context) override;

 private:
  const Certificate* proof_for(const Attempt& attempt, const MotionDepth& deepest, std::span<const Unsolved> said,
                               const RunContext& context);
  const Certificate* costly_proof(const MotionDepth& deepest, const RunContext& context);
  std::string reason_for(const Attempt& attempt, const ForcedRemoval& removal, std::span<const Unsolved> said) const;

  const Assembly& assembly_;
  const Verifier& verifier_;
  Oracle& oracle_;
  const ProofOptions& proofs_;
  PathNormalizer normalizer_;
  MotionDepthMeter meter_;
  unsigned failed_proofs_ = 0;  // of high effort about forced pairs, one after the other
};

}  // namespace dismantle
