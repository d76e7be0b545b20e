/// Immobility provers: can these parts be separated at all?
#pragma once

#include <compare>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/certificate.h"
#include "dismantle/export.h"
#include "dismantle/run_context.h"
#include "dismantle/simulator.h"

namespace dismantle {

class PartMemo;

/// How long a proof takes, found or not. The engine runs provers of low effort earlier and more often.
enum class ProofEffort {
  trivial,  ///< milliseconds: before every search
  low,      ///< up to a second or two: before searches of some depth
  medium,   ///< up to ten seconds: after searches that found nothing
  high,     ///< up to half a minute: after deep searches that found nothing
};

/// What a prover is for.
struct ProverTraits {
  ProofEffort effort = ProofEffort::low;
  std::size_t min_parts = 2, max_parts = 2;  ///< of the moving and the fixed parts together
  /// False: what is proved of the parts as assembled holds wherever they have been moved since, because no valid motion
  /// leads out of it; such provers are asked about parts as assembled only. True: the prover looks at where parts are.
  bool depends_on_poses = false;
};

/// "Can the moving parts be separated from the fixed ones?"
struct SeparationQuery {
  const Assembly& assembly;
  std::vector<PlacedPart> moving, fixed;  ///< not empty; distinct parts
  double tolerance = 0;                   ///< verify.max_penetration; assembly units, > 0
  double share = 1;                       ///< (0, 1]: the proof is for motions that cut in by this share of `tolerance`
  PartMemo& memo;                         ///< of `assembly`

  double margin() const { return share * tolerance; }
};

/// Proves that parts cannot be separated. Sound: a certificate is never given for parts that a motion can separate
/// which cuts in by no more than the initial overlap and margin(). Not complete: nothing means "not proved".
/// Deterministic, on any number of threads; with work limited by counts, not seconds. const functions may be called
/// from several threads.
class DISMANTLE_API ImmobilityProver {
 public:
  virtual ~ImmobilityProver();
  virtual ProverTraits traits() const noexcept = 0;
  /// Fills all of the certificate but `kind`, `full_tolerance` and `margin`, which the caller knows. The first of its
  /// parts may be a fixed one: separating is mutual. Nothing when told to stop.
  virtual std::optional<Certificate> prove(const SeparationQuery& query, const RunContext& context) const = 0;
  /// What is wrong with a certificate of this kind; empty when it holds. The query has its first part moving and the
  /// others fixed, where the certificate has them. This proves the claim again and compares parts and numbers.
  virtual std::string objection(const Certificate& certificate, const SeparationQuery& query,
                                const RunContext& context) const;
};

/// A question about parts as they are assembled, to be answered by the provers of one effort.
struct SeparationQuestion {
  std::vector<PartId> parts;  ///< >= 2; of a pair: the one from the other, of more: any of them from the others
  ProofEffort effort = ProofEffort::low;
  double share = 1;  ///< as SeparationQuery::share
  auto operator<=>(const SeparationQuestion&) const = default;
};

}  // namespace dismantle
