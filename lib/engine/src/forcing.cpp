#include "forcing.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <utility>

#include "dismantle/verification/valid_stretch.h"
#include "forced_reason.h"
#include "oracle.h"
#include "stopwatch.h"

namespace dismantle {

namespace {

/// Does the proof say that the moving parts cannot leave the fixed ones? It does when the part that it is about is on
/// one side, and all its other parts are on the other. A proof of the kind translations is about whichever of its parts
/// move.
bool divides(const Certificate& proof, const Attempt& attempt) {
  const auto all_in = [](std::span<const PartId> parts, const std::vector<PlacedPart>& side) {
    return std::all_of(parts.begin(), parts.end(), [&](PartId id) { return contains(side, id); });
  };
  const std::span<const PartId> others(proof.parts.begin() + 1, proof.parts.end());
  if ((contains(attempt.moving, proof.parts.front()) && all_in(others, attempt.fixed)) ||
      (contains(attempt.fixed, proof.parts.front()) && all_in(others, attempt.moving)))
    return true;
  return proof.kind == "translations" && proof.poses.empty() && !all_in(proof.parts, attempt.moving) &&
         !all_in(proof.parts, attempt.fixed) && std::all_of(proof.parts.begin(), proof.parts.end(), [&](PartId id) {
           return contains(attempt.moving, id) || contains(attempt.fixed, id);
         });
}

}  // namespace

std::optional<MotionDepth> Forcing::depth(const std::vector<PartId>& moving, const std::vector<PlacedPart>& fixed,
                                          const Path& path, const MotionDepthOptions& options,
                                          const RunContext& context) {
  return meter_.deepest(moving, fixed, path, options, context);
}

/// What a forced step cuts through was perhaps never the last pair of its group, for which costly proofs are tried. In
/// one assembly such pairs are mostly of one kind.
const Certificate* Forcing::costly_proof(const MotionDepth& deepest, const RunContext& context) {
  constexpr unsigned kMostFailures = 2;
  if (failed_proofs_ >= kMostFailures || deepest.excess() <= 0) return nullptr;
  const Certificate* found = oracle_.proofs().prove_high(deepest.part, deepest.other, context);
  failed_proofs_ = found != nullptr ? 0 : failed_proofs_ + 1;
  return found;
}

/// A proof about the deepest pair first, then one of those that are known, at last a costly one.
const Certificate* Forcing::proof_for(const Attempt& attempt, const MotionDepth& deepest,
                                      std::span<const Unsolved> said, const RunContext& context) {
  if (!context.should_stop())
    if (const Certificate* pair =
            oracle_.proofs().prove_pair(deepest.part, deepest.other, ProofEffort::medium, context))
      return pair;
  for (const Unsolved& u : said)
    if (u.certificate != nullptr && divides(*u.certificate, attempt)) return u.certificate;
  return context.should_stop() ? nullptr : costly_proof(deepest, context);
}

void Forcing::prove_left(std::vector<Unsolved>& unsolved, const std::vector<std::vector<PlacedPart>>& groups,
                         const RunContext& context) {
  dismantle::prove_left(unsolved, groups, oracle_.proofs(), proofs_, context);
}

/// The text of the proof, or what would have to bend, the cost of the searches in machine-independent counts, and a
/// line of a configuration that would allow it.
std::string Forcing::reason_for(const Attempt& attempt, const ForcedRemoval& removal,
                                std::span<const Unsolved> said) const {
  const Certificate* proof = removal.cut.certificate.get();
  std::string text = proof != nullptr ? proof->text : std::string();
  if (proof != nullptr && proof->full_tolerance) return text;
  const MotionDepth& deepest = removal.cut.deepest;
  const double tolerance = verifier_.options().max_penetration;
  const auto at = [&](const std::vector<PlacedPart>& side, PartId part) {
    return std::find_if(side.begin(), side.end(), [&](const PlacedPart& p) { return p.part == part; });
  };
  const auto part = at(attempt.moving, deepest.part), other = at(attempt.fixed, deepest.other);
  if (deepest.depth > 0 && part != attempt.moving.end() && other != attempt.fixed.end()) {
    std::vector<Pose> motion;
    const auto column = static_cast<std::size_t>(part - attempt.moving.begin());
    for (const auto& instant : removal.path) motion.push_back(instant[column]);
    if (!text.empty()) text += "; ";
    text += hindrance_text(assembly_, deepest, motion, *other, tolerance);
  }
  // Time may have gone into either part of the pair.
  std::vector<PartId> searched = ids_of(attempt.moving);
  if (attempt.fixed.size() == 1 || attempt.moving.size() > 1) searched.push_back(deepest.other);
  SearchEffort effort;
  for (const PartId id : searched) {
    const SearchEffort own = oracle_.effort_on(id);
    effort.attempts += own.attempts;
    effort.depth = std::max(effort.depth, own.depth);
    effort.cost += own.cost;
  }
  if (!text.empty()) text += "; ";
  if (effort.attempts == 0) {
    std::string why = "no straight motion was found to be valid, and no search came to its end";
    for (const Unsolved& u : said)
      if (u.certificate == nullptr && !u.message.empty() && u.outcome != Outcome::cancelled &&
          u.outcome != Outcome::timeout && contains(attempt.moving, u.part))
        why = u.message;
    text += why;
  } else {
    text += fmt::format("{} of '{}'{}, {:.0f} steps and state checks, found no path",
                        effort.attempts == 1 ? "1 search" : fmt::format("{} searches", effort.attempts),
                        oracle_.planner_id(), effort.depth == 0 ? "" : fmt::format(" to depth {}", effort.depth),
                        effort.cost);
  }
  if (removal.cut.lower_bound || deepest.depth <= 0) return text;
  const std::string line = suggestion_text(assembly_, deepest, tolerance);
  return line.empty() ? text : text + "; if it is meant to be so: `" + line + "`";
}

const AttemptResult& Forcing::propose_forced(const Attempt& attempt, const Path& path,
                                             const std::optional<MotionDepth>& known, std::span<const Unsolved> said,
                                             RunContext& context) {
  const auto begin = std::chrono::steady_clock::now();
  AttemptResult answer;
  answer.attempt = canonical(attempt, assembly_.parts.size());
  answer.proposed = true;
  const std::vector<PartId> moving = ids_of(answer.attempt.moving);
  if (moving != ids_of(attempt.moving) || answer.attempt.fixed.empty())
    throw std::invalid_argument("a forced path whose parts are not in ascending order, or that leaves nothing behind");
  NormalizedPath written = normalizer_.normalize(path, answer.attempt.moving);
  if (!written.problem.empty()) throw std::invalid_argument("a forced path is unusable: " + written.problem);
  ForcedRemoval removal{std::move(written.path), {}};
  // Measured as finely as the verifier does: planners compare motions by depths that are exact to the tolerance only.
  const double share = 0.01;
  std::optional<MotionDepth> deepest =
      depth(moving, answer.attempt.fixed, removal.path, {0.1 * verifier_.options().max_penetration, share}, context);
  removal.cut.lower_bound = context.should_stop();
  if (removal.cut.lower_bound && known && (!deepest || known->excess() >= deepest->excess())) deepest = known;
  removal.cut.deepest = deepest.value_or(MotionDepth{moving.front(), answer.attempt.fixed.front().part});
  const Certificate* proof = proof_for(answer.attempt, removal.cut.deepest, said, context);
  if (proof != nullptr) removal.cut.certificate = std::make_shared<const Certificate>(*proof);
  removal.cut.reason = reason_for(answer.attempt, removal, said);
  const double to_input = 1 / assembly_.normalization.scale;
  context.log(LogLevel::info,
              fmt::format("forced: '{}' past '{}', {}{:.4g} deep", assembly_.parts[removal.cut.deepest.part].name,
                          assembly_.parts[removal.cut.deepest.other].name, removal.cut.lower_bound ? "at least " : "",
                          removal.cut.deepest.depth * to_input));
  // An instant where it begins to cut in: the plan states how far the parts come.
  removal.path =
      divided_where_valid(assembly_, verifier_, moving, answer.attempt.fixed, std::move(removal.path), context);
  answer.forced = std::make_shared<const ForcedRemoval>(std::move(removal));
  answer.result.fail(Outcome::exhausted, answer.forced->cut.reason);
  answer.seconds = seconds_since(begin);
  return oracle_.keep_forced(std::move(answer));
}

}  // namespace dismantle
