#include "dismantle/path_planner.h"

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <utility>

namespace dismantle {

VerifiedPath::VerifiedPath(Path poses, double max_penetration, std::optional<PartId> released, std::uint64_t checker)
    : poses_(std::move(poses)), max_penetration_(max_penetration), released_(released), checker_(checker) {}

PathChecker::PathChecker() {
  static std::atomic<std::uint64_t> last{0};
  id_ = ++last;
}
PathChecker::~PathChecker() = default;

VerifiedPath PathChecker::accept(Path poses, double max_penetration, std::optional<PartId> released) const {
  return {std::move(poses), max_penetration, released, id_};
}

SearchState::~SearchState() = default;

SearchStats& SearchStats::operator+=(const SearchStats& other) {
  steps += other.steps;
  state_checks += other.state_checks;
  nodes += other.nodes;
  refused += other.refused;
  resumed_nodes += other.resumed_nodes;
  spared += other.spared;
  cost += other.cost;
  for (const auto& [name, value] : other.extra) extra[name] += value;
  return *this;
}

std::map<std::string, double> SearchStats::by_name() const {
  std::map<std::string, double> all = extra;
  const std::pair<const char*, std::uint64_t> counts[] = {{"steps", steps},   {"state_checks", state_checks},
                                                          {"nodes", nodes},   {"refused", refused},
                                                          {"spared", spared}, {"resumed_nodes", resumed_nodes}};
  for (const auto& [name, count] : counts)
    if (count > 0) all[name] = static_cast<double>(count);
  if (cost > 0) all["cost"] = cost;
  return all;
}

PathResult PathResult::failure(Outcome outcome, std::string message) {
  PathResult result;
  result.fail(outcome, std::move(message));
  return result;
}

void PathResult::solve(VerifiedPath path, unsigned actions) {
  outcome_ = Outcome::solved;
  path_ = std::move(path);
  depth = actions;
  message.clear();
}

void PathResult::start_is_goal(std::optional<VerifiedPath> path) {
  outcome_ = Outcome::start_is_goal;
  path_ = std::move(path);
  depth = 0;
  message.clear();
}

void PathResult::fail(Outcome outcome, std::string why) {
  if (is_success(outcome)) throw std::invalid_argument("a success needs a verified path");
  outcome_ = outcome;
  path_.reset();
  if (!why.empty()) message = std::move(why);
}

SearchStatus status_of(Outcome outcome) {
  if (is_success(outcome)) return SearchStatus::solved;
  const bool nothing_left =
      outcome == Outcome::depth_limit || outcome == Outcome::exhausted || outcome == Outcome::infeasible;
  return nothing_left ? SearchStatus::exhausted : SearchStatus::failed;
}

PathSearch::~PathSearch() = default;
PathPlanner::~PathPlanner() = default;

PathResult run_to_end(PathSearch& search) {
  while (search.run({}) == SearchStatus::paused) {
  }
  return search.result();
}

PathResult plan_path(PathPlanner& planner, const PathQuery& query, RunContext& context) {
  return run_to_end(*planner.start(query, context));
}

namespace {

/// The smaller of two limits; 0 = no limit.
template <class T>
T tighter(T a, T b) {
  return a > 0 && b > 0 ? std::min(a, b) : std::max(a, b);
}

class FunctionSearch final : public PathSearch {
 public:
  FunctionSearch(FunctionPathPlanner& planner, const PathQuery& query, RunContext& context)
      : planner_(planner), query_(query), context_(context), deadline_(deadline_of(query.budget)) {}

  SearchStatus run(const Budget& portion) override {
    if (over_) return status_of(result_.outcome());
    PathQuery query = query_;
    query.portion = portion.max_steps > 0 || portion.timeout > 0;
    query.budget.max_steps = tighter(query.budget.max_steps, portion.max_steps);
    query.budget.timeout = tighter(query.budget.timeout, portion.timeout);
    const Deadline whole = context_.deadline.earlier(deadline_), end = deadline_of(portion);
    RunContext context = context_;
    context.deadline = whole.earlier(end);
    result_ = planner_.plan(query, context);
    const bool cancelled = result_.outcome() == Outcome::cancelled;  // some report a deadline like this, too
    const bool stopped = result_.outcome() == Outcome::timeout || (cancelled && !context.cancel.cancelled());
    const bool by_portion = query.budget.max_steps != query_.budget.max_steps || end.passed();
    const bool cut_short = stopped && by_portion && !whole.passed();
    over_ = !cut_short && !result_.may_improve;
    return cut_short ? SearchStatus::paused : status_of(result_.outcome());
  }
  PathResult result() override { return result_; }

 private:
  static Deadline deadline_of(const Budget& budget) {
    return budget.timeout > 0 ? Deadline::after_seconds(budget.timeout) : Deadline();
  }

  FunctionPathPlanner& planner_;
  const PathQuery& query_;
  RunContext& context_;
  Deadline deadline_;
  PathResult result_;
  bool over_ = false;
};

}  // namespace

std::unique_ptr<PathSearch> FunctionPathPlanner::start(const PathQuery& query, RunContext& context) {
  return std::make_unique<FunctionSearch>(*this, query, context);
}

}  // namespace dismantle
