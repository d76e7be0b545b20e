#include "members.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "dismantle/search/time_limit.h"

namespace dismantle::portfolio {

Members::Members(const std::vector<Member>& list, const std::vector<std::shared_ptr<PathPlanner>>& planners,
                 const PathQuery& query)
    : query_(query), participation_(query), deadline_(path::deadline_of(query.budget)) {
  std::map<std::string, std::uint64_t> times;
  for (std::size_t k = 0; k < planners.size(); ++k) {
    const std::string& type = list[k].plugin.type();
    members_.emplace_back(*planners[k], list[k], type, times[type]++);
  }
  for (MemberSearch& m : members_) {
    if (!participation_.takes_part(m.member(), m.planner().traits())) continue;
    if (primary_ == nullptr) primary_ = &m;
    order_.push_back(&m);
  }
  if (participation_.depth_limited())
    std::stable_partition(order_.begin(), order_.end(), [](const MemberSearch* m) { return m->member().first; });
}

/// The rest of the query's budget.
std::uint64_t Members::budget_left() const {
  if (query_.budget.max_steps == 0) return kUnlimited;
  std::uint64_t spent = 0;
  for (const MemberSearch& m : members_) spent += m.spent();
  return query_.budget.max_steps - std::min(query_.budget.max_steps, spent);
}

/// The rest of the member's own budget.
std::uint64_t Members::allowance(const MemberSearch& m) const {
  const Member& member = m.member();
  std::uint64_t most = member.max_steps > 0 ? static_cast<std::uint64_t>(member.max_steps) : kUnlimited;
  if (member.share < 1 && query_.budget.max_steps > 0)
    most = std::min(most,
                    static_cast<std::uint64_t>(std::ceil(member.share * static_cast<double>(query_.budget.max_steps))));
  return most == kUnlimited ? most : most - std::min(most, m.spent());
}

/// The first member is exhausted, and the verifier has refused paths of it.
bool Members::was_refused(const MemberSearch& m) const {
  return participation_.depth_limited() && m.member().when_refused && primary_ != &m &&
         primary_->last().outcome() == Outcome::exhausted && primary_->last().stats.refused > 0;
}

bool Members::ready(const MemberSearch& m) { return was_refused(m) || participation_.deep_enough(m.member()); }

void Members::begin(MemberSearch& m, const RunContext& context, const PathChecker& checker) {
  PathQuery query{query_.assembly,  query_.simulator, query_.prepared, query_.scene, query_.budget,
                  query_.tolerance, checker,          query_.goal,     nullptr};
  if (was_refused(m)) query.budget.max_depth = 0;
  if (query_.budget.timeout > 0) query.budget.timeout = std::max(1e-9, deadline_.seconds_left());
  if (const auto* state = dynamic_cast<const PortfolioState*>(query_.resume_from))
    query.resume_from = state->members[static_cast<std::size_t>(&m - members_.data())].get();
  m.begin(query, context);
}

std::optional<Decision> Members::prepare(MemberSearch& m, const RunContext& context, const Portion& portion) {
  if (portion.over()) return Decision{SearchStatus::paused, nullptr};
  if (budget_left() == 0) {
    m.time_out();
    return Decision{SearchStatus::failed, &m};
  }
  if (!m.begun()) begin(m, context, query_.checker);
  return std::nullopt;
}

Decision Members::run(MemberSearch& m, std::uint64_t most, Portion& portion) {
  const std::uint64_t before = m.spent();
  const std::uint64_t steps = std::min({most, portion.left, budget_left(), allowance(m)});
  Budget own;
  if (steps != kUnlimited) own.max_steps = std::max<std::uint64_t>(1, steps);
  if (const double left = portion.end.seconds_left(); std::isfinite(left)) own.timeout = std::max(1e-9, left);
  const SearchStatus status = m.run(own);
  if (portion.left != kUnlimited) portion.left -= std::min(portion.left, m.spent() - before);
  switch (status) {
    case SearchStatus::solved:
      return {status, &m};
    case SearchStatus::failed:
      return m.last().outcome() == Outcome::unsupported ? Decision{} : Decision{status, &m};
    case SearchStatus::exhausted:
      return {status, m.member().final && m.last().outcome() == Outcome::exhausted ? &m : nullptr};
    case SearchStatus::paused:
      break;
  }
  if (budget_left() == 0) {
    m.time_out();
    return {SearchStatus::failed, &m};
  }
  if (allowance(m) == 0) {
    m.leave_out();
    return {};
  }
  return {SearchStatus::paused, nullptr};
}

}  // namespace dismantle::portfolio
