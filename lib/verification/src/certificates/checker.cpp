#include "certificates/checker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "dismantle/verification/check_certificate.h"

namespace dismantle::certificates {

const Checker* checker_of(std::string_view kind) {
  constexpr ProverTraits kPair{ProofEffort::low, 2, 2, false};
  constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();
  static const std::vector<Checker> all = {
      {"overlap_lock", kPair, {{"point", 3}, {"depth"}, {"allowed"}}, objection_to_overlap_lock},
      {"disc",
       {ProofEffort::medium, 2, 2, false},
       {{"center", 3}, {"axis", 3}, {"diameter"}, {"half_thickness"}, {"frame", 7}, {"region", 0}, {"normals", 0}},
       objection_to_disc},
      {"enclosed_ball",
       {ProofEffort::low, 2, kAny, true},
       {{"center", 3}, {"radius"}, {"cell"}},
       objection_to_enclosed_ball},
      {"ring", kPair, {{"center", 3}, {"axis", 3}, {"diameter"}, {"opening"}, {"planes", 0}}, objection_to_ring},
      {"spool", kPair, {{"center", 3}, {"axis", 3}, {"rim"}, {"circle"}, {"planes", 2}}, objection_to_spool},
      {"hook",
       kPair,
       {{"hole", 3},
        {"width"},
        {"first_bend", 3},
        {"second_bend", 3},
        {"normal", 3},
        {"path", 0},
        {"first_legs", 6},
        {"second_legs", 6},
        {"steps", 2},
        {"points", 2}},
       objection_to_hook},
      {"configuration_cells",
       {ProofEffort::high, 2, 2, false},
       {{"depth"},
        {"shift"},
        {"turn"},
        {"lower", 6},
        {"upper", 6},
        {"cells"},
        {"points", 0},
        {"directions", 0},
        {"box", 12},
        {"tree", 0}},
       objection_to_configuration_cells},
      {"interlock_lp",
       {ProofEffort::high, 2, kAny, false},
       {{"depth"},
        {"shift"},
        {"turn"},
        {"half_spaces"},
        {"order", 0},
        {"axes", 4},
        {"bounds", 0},
        {"pairs", 0},
        {"rows", 0},
        {"multipliers", 0}},
       objection_to_interlock_lp},
      {"translations",
       {ProofEffort::low, 2, kAny, false},
       {{"axes", 4},
        {"pitch", 3},
        {"origin", 3},
        {"inset", 3},
        {"counts", 0},
        {"cells", 0},
        {"arrangements", 0}},
       objection_to_translations},
  };
  const auto found = std::find_if(all.begin(), all.end(), [&](const Checker& c) { return c.kind == kind; });
  return found == all.end() ? nullptr : &*found;
}

std::string objection(const Checker& checker, const Certificate& certificate, const SeparationQuery& query,
                      const RunContext& context) {
  for (const NumberList& list : checker.numbers) {
    const auto found = certificate.numbers.find(std::string(list.name));
    if (found == certificate.numbers.end()) return fmt::format("the number '{}' is missing", list.name);
    if (list.count > 0 && found->second.size() != list.count)
      return fmt::format("'{}' has {} numbers in place of {}", list.name, found->second.size(), list.count);
    if (!std::all_of(found->second.begin(), found->second.end(), [](double x) { return std::isfinite(x); }))
      return fmt::format("the number '{}' is not finite", list.name);
  }
  for (const auto& numbers : certificate.numbers)
    if (std::none_of(checker.numbers.begin(), checker.numbers.end(),
                     [&](const NumberList& l) { return l.name == numbers.first; }))
      return fmt::format("the number '{}' is no part of the proof", numbers.first);
  return checker.objection(certificate, query, context);
}

}  // namespace dismantle::certificates

namespace dismantle {

std::optional<std::string> independent_objection(const Certificate& certificate, const SeparationQuery& query,
                                                 const RunContext& context) {
  const certificates::Checker* checker = certificates::checker_of(certificate.kind);
  if (checker == nullptr) return std::nullopt;
  return certificates::objection(*checker, certificate, query, context);
}

}  // namespace dismantle
