/// Independent checkers of certificates, one for each kind. They are small and share no code with the provers.
///
/// A checker accepts a certificate only if its numbers make up a proof. It does not search: it measures, multiplies,
/// and divides the pieces that the certificate gives.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "dismantle/immobility_prover.h"

namespace dismantle::certificates {

/// A list of numbers that certificates of a kind must have.
struct NumberList {
  std::string_view name;
  std::size_t count = 1;  ///< 0: any number of them
};

/// Returns what is wrong with a certificate; empty when it holds. In the query its first part moves and the others are
/// fixed, at the certificate's poses. The caller has checked names, lengths and finiteness of the lists.
using Objection = std::string (*)(const Certificate& certificate, const SeparationQuery& query,
                                  const RunContext& context);

/// The check of one kind of certificate.
struct Checker {
  std::string_view kind;
  ProverTraits traits;
  std::vector<NumberList> numbers;
  Objection objection = nullptr;
};

/// Returns nullptr for kinds that only their prover can check.
const Checker* checker_of(std::string_view kind);

/// Checks that the lists are those of the kind, then the proof.
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

std::string objection_to_translations(const Certificate& certificate, const SeparationQuery& query,
                                      const RunContext& context);

}  // namespace dismantle::certificates
