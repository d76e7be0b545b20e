#include "dismantle/ompl/candidate_paths.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "dismantle/search/candidates.h"

namespace dismantle::sampling {

bool CandidatePaths::accepts(SamplingProblem& problem, const std::vector<SamplingProblem::StateType>& states,
                             PathResult& result, std::size_t& edge, const std::vector<Pose>& end) {
  std::vector<std::vector<SamplingProblem::StateType>> forms;
  if (simplify_ && states.size() > 2) {
    forms.push_back(problem.shortcut(states));
    if (forms.back().size() >= states.size()) forms.clear();
  }
  forms.push_back(states);
  std::vector<std::size_t> edge_of;
  std::size_t shown = 0;
  const auto form = [&](std::size_t k) -> std::optional<Path> {
    shown = k;
    if (k == forms.size()) return std::nullopt;
    Path path = problem.path(forms[k], &edge_of);
    if (!end.empty()) path.back() = end;
    return path;
  };
  const auto learn = [&](const PathCheck& check, const Path&) {
    result.message = check.reason;
    // The witness is the last instant before the fault, so the next edge is at fault. Without a witness: the last edge.
    edge = check.has_witness ? edge_of[std::min(check.instant + 1, edge_of.size() - 1)] : forms[shown].size() - 1;
    edge = std::max<std::size_t>(edge, 1);
    return true;
  };
  const auto accept = [&](VerifiedPath path) {
    result.solve(std::move(path), static_cast<unsigned>(forms[shown].size() - 1));
  };
  return path::show_forms(checker_, refused_, form, learn, accept).accepted;
}

}  // namespace dismantle::sampling
