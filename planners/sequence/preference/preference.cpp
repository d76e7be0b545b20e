#include "preference/preference.h"

#include <algorithm>
#include <exception>
#include <numeric>
#include <string>

namespace dismantle {

Preference::Preference(const SequenceQuery& query) : assembly_(query.assembly), objective_(query.objective) {
  remembers_ = std::any_of(objective_.items.begin(), objective_.items.end(), [](const ObjectiveItem& item) {
    const StepCheckTraits traits = item.check->traits();
    return traits.remembers_direction || traits.remembers_orientation || traits.remembers_shape;
  });
}

double Preference::cost_alone(const StepQuestion& question, const RunContext& context) const {
  constexpr double kRefused = 1e12;  // above all costs, so that the others keep their order
  const ObjectiveVerdict verdict = objective_.judge(question, context, &StepCheck::estimate);
  return verdict.cost + (verdict.refused ? kRefused : 0);
}

double Preference::cost(const StepQuestion& question, const RunContext& context) const {
  double sum = cost_alone(question, context);
  if (remembers_ && last_) sum += cost_alone(last_->question(&question), context) - last_alone_;
  return sum;
}

double Preference::cost(const CandidateRemoval& candidate, const RunContext& context) const {
  if (candidate.path != nullptr)
    return cost(Operation(assembly_, candidate.moving, candidate.rest, *candidate.path, objective_.up).question(),
                context);
  const Eigen::Vector3d inwards = -candidate.direction;
  return cost({assembly_, candidate.moving, candidate.rest, inwards, nullptr, objective_.up}, context);
}

std::vector<std::size_t> Preference::sorted(std::span<const CandidateRemoval> candidates,
                                            const RunContext& context) const {
  std::vector<std::size_t> order(candidates.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<double> costs;
  if (!guarded(
          [&] {
            for (const CandidateRemoval& c : candidates) costs.push_back(cost(c, context));
          },
          context))
    return order;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return costs[a] < costs[b]; });
  return order;
}

void Preference::removed(const CandidateRemoval& removal, const Trace& path, const RunContext& context) {
  if (!active()) return;
  last_.emplace(assembly_, removal.moving, removal.rest, path, objective_.up);
  guarded([&] { last_alone_ = cost_alone(last_->question(), context); }, context);
}

bool Preference::guarded(const std::function<void()>& work, const RunContext& context) const {
  if (failed_) return false;
  try {
    work();
  } catch (const std::exception& e) {
    failed_ = true;
    context.log(LogLevel::error,
                std::string("the objective is not followed any more, a step check failed: ") + e.what());
  }
  return !failed_;
}

}  // namespace dismantle
