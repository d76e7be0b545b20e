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

/// Time that a proof attempt takes, successful or not. The engine runs provers of low effort earlier and more often.
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
  /// False: the prover is only asked about parts as assembled. Its proofs still hold after valid motions, because these
  /// cannot separate the parts. True: the prover uses the current poses.
  bool depends_on_poses = false;
};

/// "Can the moving parts be separated from the fixed ones?"
struct SeparationQuery {
  const Assembly& assembly;
  std::vector<PlacedPart> moving, fixed;  ///< not empty; distinct parts
  double tolerance = 0;                   ///< verify.max_penetration; assembly units, > 0
  double share = 1;  ///< (0, 1]: the proof covers motions that cut in by up to this share of `tolerance`
  PartMemo& memo;    ///< of `assembly`

  double margin() const { return share * tolerance; }
};

/// Proves that parts cannot be separated. Sound: there is no certificate if a motion separates the parts and cuts in by
/// no more than the initial overlap plus margin(). Not complete: an empty result means "not proved". Deterministic on
/// any number of threads; work is limited by counts, not seconds. const functions may be called from several threads.
class DISMANTLE_API ImmobilityProver {
 public:
  virtual ~ImmobilityProver();
  virtual ProverTraits traits() const noexcept = 0;
  /// Fills the certificate except `kind`, `full_tolerance` and `margin`, which the caller sets. Its first part may be a
  /// fixed one, because separation is mutual. Empty if `context` asks to stop.
  virtual std::optional<Certificate> prove(const SeparationQuery& query, const RunContext& context) const = 0;
  /// Checks a certificate of this kind; returns the problem, or an empty string if it holds. In the query its first
  /// part moves and the others are fixed, at its poses. The default proves the claim again and compares parts and
  /// numbers.
  virtual std::string objection(const Certificate& certificate, const SeparationQuery& query,
                                const RunContext& context) const;
};

/// A question about parts as they are assembled, to be answered by the provers of one effort.
struct SeparationQuestion {
  std::vector<PartId> parts;  ///< >= 2; a pair: one from the other; more parts: any of them from the others
  ProofEffort effort = ProofEffort::low;
  double share = 1;  ///< as SeparationQuery::share
  auto operator<=>(const SeparationQuestion&) const = default;
};

}  // namespace dismantle
