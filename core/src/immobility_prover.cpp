#include "dismantle/immobility_prover.h"

#include <algorithm>
#include <cmath>

namespace dismantle {
namespace {

constexpr double kSameNumber = 1e-6;  // relative; what reading and writing a plan may change

bool same_numbers(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) {
    return std::abs(x - y) <= kSameNumber * std::max({1.0, std::abs(x), std::abs(y)});
  });
}

}  // namespace

ImmobilityProver::~ImmobilityProver() = default;

std::string ImmobilityProver::objection(const Certificate& certificate, const SeparationQuery& query,
                                        const RunContext& context) const {
  const std::optional<Certificate> again = prove(query, context);
  if (!again) return context.should_stop() ? "the check was stopped" : "it cannot be proved again";
  std::vector<PartId> claimed = certificate.parts, proved = again->parts;
  std::sort(claimed.begin(), claimed.end());
  std::sort(proved.begin(), proved.end());
  if (claimed != proved) return "a proof exists, but of other parts";
  for (const auto& [name, numbers] : again->numbers) {
    const auto given = certificate.numbers.find(name);
    if (given == certificate.numbers.end()) return "the number '" + name + "' is missing";
    if (!same_numbers(given->second, numbers)) return "the number '" + name + "' is not that of the proof";
  }
  for (const auto& [name, numbers] : certificate.numbers)
    if (!again->numbers.contains(name)) return "the number '" + name + "' is no part of the proof";
  return {};
}

}  // namespace dismantle
