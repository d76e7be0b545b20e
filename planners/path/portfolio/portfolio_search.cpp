#include "portfolio_search.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "dismantle/free_space/navigation_search.h"
#include "dismantle/path/placed_parts.h"
#include "dismantle/path/time_limit.h"

namespace dismantle::portfolio {

PortfolioSearch::PortfolioSearch(const Parameters& parameters,
                                 const std::vector<std::shared_ptr<PathPlanner>>& planners, const PathQuery& query,
                                 RunContext& context)
    : parameters_(parameters),
      query_(query),
      context_(context),
      limited_(query.budget.max_depth > 0),
      deadline_(path::deadline_of(query.budget)),
      turn_(static_cast<std::uint64_t>(parameters.turn)) {
  std::map<std::string, std::uint64_t> times;
  for (std::size_t k = 0; k < planners.size(); ++k) {
    const std::string& type = parameters.of[k].plugin.type();
    members_.emplace_back(*planners[k], parameters.of[k], type, times[type]++);
  }
}

bool PortfolioSearch::is_large(const Member& member) {
  if (!diagonals_) {
    const Aabb moving = path::box_of(query_.assembly, query_.scene.moving),
               fixed = path::box_of(query_.assembly, query_.scene.fixed);
    const bool known = !moving.empty() && !fixed.empty();
    diagonals_.emplace(known ? moving.size().norm() : 1, known ? fixed.size().norm() : 0);
  }
  return diagonals_->first > member.large * diagonals_->second;
}

std::uint64_t PortfolioSearch::least_depth(const Member& member) {
  const bool more = member.least_depth_large > member.least_depth && is_large(member);
  return static_cast<std::uint64_t>(more ? member.least_depth_large : member.least_depth);
}

bool PortfolioSearch::takes_part(const MemberSearch& m) {
  const PathPlannerTraits traits = m.planner().traits();
  if (!query_.goal.any_of.empty() && !traits.simultaneous_motion) return false;
  const Member& member = m.member();
  if (member.size != Size::any && is_large(member) != (member.size == Size::large)) return false;
  if (!limited_) return true;
  return member.depth_limited && (member.when_refused || query_.budget.max_depth >= least_depth(member));
}

void PortfolioSearch::choose_members() {
  for (MemberSearch& m : members_) {
    if (!takes_part(m)) continue;
    if (primary_ == nullptr) primary_ = &m;
    order_.push_back(&m);
  }
  if (limited_)
    std::stable_partition(order_.begin(), order_.end(), [](const MemberSearch* m) { return m->member().first; });
  const auto overlap_turn = static_cast<std::uint64_t>(parameters_.overlap_turn);
  const bool alternating = (limited_ ? parameters_.depth_limited_mode : parameters_.mode) == Mode::alternate;
  short_round_ = alternating && order_.size() > 1 && overlap_turn > 0 && overlap_turn < turn_ &&
                 free_space::thinner_than_overlap(query_);
}

SearchStatus PortfolioSearch::run(const Budget& portion) {
  if (status_ != SearchStatus::paused) return status_;
  if (query_.simulator.capabilities().max_moving < query_.scene.moving.size()) {
    refusal_.fail(Outcome::unsupported, "the simulator cannot move this number of parts simultaneously");
    return status_ = SearchStatus::failed;
  }
  if (order_.empty()) choose_members();
  if (order_.empty()) {
    refusal_.fail(limited_ ? Outcome::depth_limit : Outcome::unsupported,
                  "no planner of the portfolio participates in such a search");
    return status_ = limited_ ? SearchStatus::exhausted : SearchStatus::failed;
  }
  Portion left;
  if (portion.max_steps > 0) left.steps_left = portion.max_steps;
  const Deadline whole = deadline_;
  deadline_ = deadline_.earlier(path::deadline_of(portion));
  const bool alternating = (limited_ ? parameters_.depth_limited_mode : parameters_.mode) == Mode::alternate;
  const Decision decision = alternating ? alternate(left) : fall_back(left);
  deadline_ = whole;
  decided_by_ = decision.by != nullptr ? decision.by : primary_;
  return status_ = decision.status;
}

/// The rest of the query's budget.
std::uint64_t PortfolioSearch::budget_left() const {
  if (query_.budget.max_steps == 0) return kUnlimited;
  std::uint64_t spent = 0;
  for (const MemberSearch& m : members_) spent += m.spent();
  return query_.budget.max_steps - std::min(query_.budget.max_steps, spent);
}

/// The rest of the member's own budget.
std::uint64_t PortfolioSearch::allowance(const MemberSearch& m) const {
  const Member& member = m.member();
  std::uint64_t most = member.max_steps > 0 ? static_cast<std::uint64_t>(member.max_steps) : kUnlimited;
  if (member.share < 1 && query_.budget.max_steps > 0)
    most = std::min(most,
                    static_cast<std::uint64_t>(std::ceil(member.share * static_cast<double>(query_.budget.max_steps))));
  return most == kUnlimited ? most : most - std::min(most, m.spent());
}

/// The first member is exhausted, and the verifier has refused paths of it.
bool PortfolioSearch::was_refused(const MemberSearch& m) const {
  return limited_ && m.member().when_refused && primary_ != &m && primary_->last().outcome() == Outcome::exhausted &&
         primary_->last().stats.refused > 0;
}

bool PortfolioSearch::ready(const MemberSearch& m) {
  return !limited_ || was_refused(m) || query_.budget.max_depth >= least_depth(m.member());
}

void PortfolioSearch::begin(MemberSearch& m, const RunContext& context, const PathChecker& checker) {
  PathQuery query{query_.assembly,  query_.simulator, query_.prepared, query_.scene, query_.budget,
                  query_.tolerance, checker,          query_.goal,     nullptr};
  if (was_refused(m)) query.budget.max_depth = 0;
  if (query_.budget.timeout > 0) query.budget.timeout = std::max(1e-9, deadline_.seconds_left());
  if (const auto* state = dynamic_cast<const PortfolioState*>(query_.resume_from))
    query.resume_from = state->members[static_cast<std::size_t>(&m - members_.data())].get();
  m.begin(query, context);
}

PortfolioSearch::Decision PortfolioSearch::run_member(MemberSearch& m, std::uint64_t turn, Portion& portion) {
  const std::uint64_t before = m.spent();
  const std::uint64_t steps = std::min({turn, portion.steps_left, budget_left(), allowance(m)});
  const SearchStatus status = m.run(steps == kUnlimited ? 0 : std::max<std::uint64_t>(1, steps));
  if (portion.steps_left != kUnlimited) portion.steps_left -= std::min(portion.steps_left, m.spent() - before);
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

PortfolioSearch::Decision PortfolioSearch::fall_back(Portion& portion) {
  if (at_ == 0 && !order_.front()->begun() && portion.steps_left == kUnlimited && may_run_beside()) {
    const Decision first = run_beside_first(portion);
    if (first.status != SearchStatus::exhausted || first.by != nullptr) return first;
  }
  return run_in_order(at_, context_, portion);
}

PortfolioSearch::Decision PortfolioSearch::run_in_order(std::size_t& at, const RunContext& context, Portion& portion) {
  for (; at < order_.size(); ++at) {
    MemberSearch& m = *order_[at];
    if (!m.begun() && !ready(m)) m.leave_out();
    while (!m.ended()) {
      if (portion.steps_left == 0) return {SearchStatus::paused, nullptr};
      if (budget_left() == 0) {
        m.time_out();
        return {SearchStatus::failed, &m};
      }
      if (!m.begun()) begin(m, context, query_.checker);
      const Decision decision = run_member(m, kUnlimited, portion);
      if (decision.status == SearchStatus::solved || decision.status == SearchStatus::failed || decision.by != nullptr)
        return decision;
    }
  }
  return {};
}

/// Works in rounds. Each member that is ready has one turn in a round.
PortfolioSearch::Decision PortfolioSearch::alternate(Portion& portion) {
  while (true) {
    if (at_ == order_.size()) {
      if (std::all_of(order_.begin(), order_.end(), [](const MemberSearch* m) { return m->ended(); })) return {};
      // A round with a short turn of the first member is followed by a full round of the same length.
      if (!short_round_ || primary_->ended())
        turn_ = static_cast<std::uint64_t>(std::min(parameters_.growth * static_cast<double>(turn_), 4e18));
      short_round_ = false;
      at_ = 0;
    }
    MemberSearch& m = *order_[at_];
    const bool waits =
        &m != primary_ && !primary_->ended() && primary_->spent() < static_cast<std::uint64_t>(m.member().after);
    if (!m.begun() && !m.ended() && !waits && !ready(m)) m.leave_out();
    if (!m.ended() && !waits) {
      const Decision decision = take_turn(m, portion);
      if (decision.status != SearchStatus::exhausted || decision.by != nullptr) return decision;
    }
    in_turn_ = false;
    ++at_;
  }
}

/// Returns `exhausted` when the turn is over, `paused` when the portion is.
PortfolioSearch::Decision PortfolioSearch::take_turn(MemberSearch& m, Portion& portion) {
  if (portion.steps_left == 0) return {SearchStatus::paused, nullptr};
  if (budget_left() == 0) {
    m.time_out();
    return {SearchStatus::failed, &m};
  }
  if (!m.begun()) begin(m, context_, query_.checker);
  if (!std::exchange(in_turn_, true)) turn_began_ = m.spent();
  const bool alone = std::all_of(order_.begin(), order_.end(),
                                 [&](const MemberSearch* other) { return other == &m || other->ended(); });
  std::uint64_t length = short_round_ && &m == primary_ ? static_cast<std::uint64_t>(parameters_.overlap_turn) : turn_;
  if (alone || m.member().whole) length = kUnlimited;
  const std::uint64_t left = length == kUnlimited ? length : length - std::min(length, m.spent() - turn_began_);
  const Decision decision = run_member(m, left, portion);
  if (decision.status != SearchStatus::paused) return decision;
  const bool turn_goes_on = length == kUnlimited || m.spent() - turn_began_ < length;
  return portion.steps_left == 0 && turn_goes_on ? decision : Decision{};
}

PathResult PortfolioSearch::result() {
  if (decided_by_ == nullptr) return refusal_;
  PathResult all = decided_by_->last();
  all.stats = {};
  auto state = std::make_shared<PortfolioState>();
  for (const MemberSearch& m : members_) {
    const PathResult& one = m.last();
    SearchStats fixed = one.stats;
    fixed.extra.clear();
    all.stats += fixed;
    for (const auto& [name, value] : one.stats.by_name()) all.stats.extra[m.name() + "_" + name] += value;
    for (const PartId part : one.blocked_by)
      if (std::find(all.blocked_by.begin(), all.blocked_by.end(), part) == all.blocked_by.end())
        all.blocked_by.push_back(part);
    state->members.push_back(one.state);
  }
  if (is_success(all.outcome())) return all;
  if (all.message.empty() && primary_ != nullptr) all.message = primary_->last().message;
  all.state = std::move(state);
  return all;
}

}  // namespace dismantle::portfolio
