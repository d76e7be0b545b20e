/// Independent checkers of certificates, one for each kind: small, and without any code of the provers.
///
/// A checker accepts a certificate only if its numbers make up a proof. It does not search: what it does beyond
/// multiplying and measuring is to divide what the certificate gives into smaller pieces.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "dismantle/immobility_prover.h"

namespace dismantle::certificates {

/// A list of numbers that certificates of a kind have.
struct NumberList {
  std::string_view name;
  std::size_t count = 1;  ///< 0: any number of them
};

/// What is wrong with a certificate; empty when it holds. The query has its first part moving and the others fixed,
/// where the certificate has them. All lists of the kind are there, of the right length, and finite.
using Objection = std::string (*)(const Certificate& certificate, const SeparationQuery& query,
                                  const RunContext& context);

/// How certificates of a kind are checked.
struct Checker {
  std::string_view kind;
  ProverTraits traits;
  std::vector<NumberList> numbers;
  Objection objection = nullptr;
};

/// nullptr: certificates of this kind are checked by their prover alone.
const Checker* checker_of(std::string_view kind);

/// Checks that its lists are those of the kind, then the proof.
std::string objection(const Checker& checker, const Certificate& certificate, const SeparationQuery& query,
                      const RunContext& context);

std::string objection_to_overlap_lock(const Certificate& certificate, const SeparationQuery& query,
                                      const RunContext& context);
std::string objection_to_disc(const Certificate& certificate, const SeparationQuery& query, const RunContext& context);
std::string objection_to_enclosed_ball(const Certificate& certificate, const SeparationQuery& query,
                                       const RunContext& context);
std::string objection_to_configuration_cells(const Certificate& certificate, const SeparationQuery& query,
                                             const RunContext& context);
std::string objection_to_hook(const Certificate& certificate, const SeparationQuery& query, const RunContext& context);
std::string objection_to_interlock_lp(const Certificate& certificate, const SeparationQuery& query,
                                      const RunContext& context);
std::string objection_to_ring(const Certificate& certificate, const SeparationQuery& query, const RunContext& context);
std::string objection_to_spool(const Certificate& certificate, const SeparationQuery& query, const RunContext& context);

}  // namespace dismantle::certificates
