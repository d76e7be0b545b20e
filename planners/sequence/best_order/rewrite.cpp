#include "best_order/rewrite.h"

#include <algorithm>
#include <deque>
#include <map>
#include <set>

#include "best_order/verdicts_in_order.h"
#include "dismantle/part_set.h"

namespace dismantle::order {

namespace {

bool same_places(const std::vector<PlacedPart>& a, const std::vector<PlacedPart>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const PlacedPart& x, const PlacedPart& y) { return x.part == y.part && x.pose == y.pose; });
}

}  // namespace

bool is_plain(const Removal& removal) {
  const AttemptResult& answer = *removal.attempt;
  return !answer.forced && !answer.out && !answer.attempt.goal.placement && answer.attempt.goal.any_of.empty() &&
         answer.path().size() > 1;
}

std::vector<Block> blocks_of(const std::vector<Removal>& plan, OrderScene& scene) {
  Disassembly done(scene.query.assembly.parts.size(), scene.query.start);
  struct Row {
    std::vector<PlacedPart> start;
    std::vector<const Removal*> steps;
    bool plain = true;
  };
  std::map<std::size_t, std::vector<Row>> rows;  // by group, in the order of their making
  std::set<std::size_t> last;                    // groups whose steps come last
  std::vector<const Removal*> at_the_end;
  for (const Removal& removal : plan) {
    const std::size_t group = done.group(removal.parts.front());
    if (removal.attempt->forced) last.insert(group);
    if (last.contains(group)) {
      at_the_end.push_back(&removal);
      last.insert(done.group_of_step(done.steps().size()));
    } else {
      std::vector<Row>& own = rows[group];
      // What moves within the group lead to comes first, as planned: they are as few as can be for it only.
      const bool plain = is_plain(removal);
      const bool led_to =
          own.size() == 1 && !own.back().plain && own.back().start.size() == done.groups()[group].size();
      if (own.empty() || (own.back().plain != plain && !led_to))
        own.push_back({done.placed(done.groups()[group]), {}, plain});
      own.back().steps.push_back(&removal);
    }
    done.add(step_of(removal));
  }
  std::vector<Block> blocks;
  for (auto& [group, own] : rows)
    for (Row& row : own) {
      Block& block = blocks.emplace_back();
      if (row.plain)
        block.segment = std::make_unique<Segment>(scene, std::move(row.start), std::move(row.steps));
      else
        block.fixed = std::move(row.steps);
    }
  blocks.emplace_back().fixed = std::move(at_the_end);
  return blocks;
}

StepsToTarget steps_to_target(const std::vector<Removal>& plan, const SequenceQuery& query) {
  const PartId target = *query.constraints.target;
  Disassembly done(query.assembly.parts.size(), query.start);
  const std::size_t group = done.group(target);
  StepsToTarget result;
  for (const Removal& removal : plan) {
    if (done.group(removal.parts.front()) == group) {
      if (!is_plain(removal)) return result;
      if (contains(removal.parts, target) && !kept_together(removal.parts, query.constraints)) return result;
      result.steps.push_back(&removal);
    }
    done.add(step_of(removal));
    if (done.group(target) != group) break;
  }
  result.whole = fulfilled(done, query.constraints);
  return result;
}

namespace {

struct SumOptions {
  std::optional<Eigen::Vector3d> up{};  // overrides that of the steps
  double most = kForbidden;             // above it need not be the whole sum
  std::size_t every = 1;                // one of so many steps stands for all of them
};

/// Sum of what `ask` says of the steps as assembly operations.
template <class Ask>
double sum_of(const std::vector<Removal>& plan, const SequenceQuery& query, const SumOptions& options,
              const RunContext& context, Ask ask, std::vector<double>* by_check = nullptr) {
  Disassembly done(query.assembly.parts.size(), query.start);
  std::deque<Operation> operations;
  for (const Removal& removal : plan) {
    const std::size_t group = done.group(removal.parts.front());
    const std::vector<PartId> rest = without(done.groups()[group], removal.parts);
    operations.emplace_front(query.assembly, done.placed(removal.parts), done.placed(rest), removal.attempt->path(),
                             options.up.value_or(removal.up.value_or(query.objective.up)));
    done.add(step_of(removal));
  }
  std::deque<StepQuestion> alone, questions;
  for (const Operation& o : operations) alone.push_back(o.question());
  for (std::size_t k = 0; k < operations.size(); ++k)
    questions.push_back(operations[k].question(k == 0 ? nullptr : &alone[k - 1]));
  const std::vector<ObjectiveItem>& items = query.objective.items;
  if (by_check != nullptr) by_check->assign(items.size(), 0);
  const std::size_t asked = (questions.size() + options.every - 1) / options.every;
  try {
    VerdictsInOrder verdicts(asked, options.most, static_cast<double>(options.every));
    verdicts.find(context, [&](std::size_t k) { return ask(questions[k * options.every]); });
    double sum = verdicts.sum();
    if (verdicts.decided()) {
      if (by_check != nullptr) by_check->clear();
      return sum;
    }
    for (std::size_t k = 0; by_check != nullptr && k < asked; ++k)
      for (std::size_t i = 0; i < items.size(); ++i) (*by_check)[i] += verdicts[k].verdicts[i].cost;
    const std::vector<StepQuestion> all(questions.begin(), questions.end());
    for (std::size_t i = 0; i < items.size(); ++i) {
      if (!items[i].check->traits().judges_plan) continue;
      const double cost = items[i].check->judge_plan(all, context).cost;
      sum += items[i].weight * cost;
      if (by_check != nullptr) (*by_check)[i] += cost;
    }
    return sum;
  } catch (const std::exception& e) {
    throw CheckFailed(e.what());
  }
}

}  // namespace

double cost_of(const std::vector<Removal>& plan, const SequenceQuery& query, const RunContext& context,
               std::vector<double>* by_check) {
  return sum_of(
      plan, query, {}, context, [&](const StepQuestion& question) { return query.objective.judge(question, context); },
      by_check);
}

double cost_within(double most, const std::vector<Removal>& plan, const SequenceQuery& query,
                   const RunContext& context) {
  Objective quick{{}, query.objective.up}, slow{{}, query.objective.up};
  for (const ObjectiveItem& item : query.objective.items)
    (item.check->traits().estimates ? slow : quick).items.push_back(item);  // what gives estimates takes longer itself
  double sum = 0;
  for (const Objective& part : {quick, slow}) {
    if (part.empty() || sum > most) continue;
    const SequenceQuery own{query.assembly, query.start, query.constraints, part, query.said};
    sum += sum_of(plan, own, {.most = most - sum}, context,
                  [&](const StepQuestion& question) { return part.judge(question, context); });
  }
  return sum;
}

double estimate_of(const std::vector<Removal>& plan, const SequenceQuery& query, const Eigen::Vector3d& up, double most,
                   const RunContext& context) {
  constexpr std::size_t kMostAsked = 100;  // steps of a long plan, at equal distances
  return sum_of(plan, query, {up, most, 1 + plan.size() / kMostAsked}, context, [&](const StepQuestion& question) {
    return query.objective.judge(question, context, &StepCheck::estimate);
  });
}

namespace {

constexpr const char* kOwn = "best_order";  // the planner of steps that no planner inside has found

/// Continues the path along `out` (unit) until the parts are apart from what stays.
void go_on(const Attempt& attempt, const Eigen::Vector3d& out, const OrderScene& scene, Path& path) {
  std::vector<PlacedPart> at_end = attempt.moving;
  for (std::size_t i = 0; i < at_end.size(); ++i) at_end[i].pose = path.back()[i];
  double most = 0;
  for (const auto* list : {&attempt.moving, &attempt.fixed})
    for (const PlacedPart& p : *list) most += scene.query.assembly.parts[p.part].mesh->box().size().norm();
  for (const PlacedPart& p : attempt.fixed) most = std::max(most, 2 * (p.pose.t - at_end.front().pose.t).norm());
  const double length = scene.sweep->distance_apart(at_end, attempt.fixed, out, most);
  if (length <= 0 && path.size() > 1) return;
  path.emplace_back();
  for (const PlacedPart& p : at_end)
    path.back().push_back({p.pose.t + (length + scene.sweep->tolerance()) * out, p.pose.q});
}

}  // namespace

Removal straight_out(std::vector<PartId> parts, std::size_t direction, const std::optional<Eigen::Vector3d>& up,
                     const Disassembly& now, OrderScene& scene) {
  const Attempt attempt{now.placed(parts), now.placed(without(now.groups()[now.group(parts.front())], parts))};
  Path path(1);
  for (const PlacedPart& p : attempt.moving) path.front().push_back(p.pose);
  go_on(attempt, scene.directions.all[direction], scene, path);
  const AttemptResult& answer = scene.oracle.propose(attempt, path, scene.context);
  if (!is_success(answer.result.outcome())) return {};
  Removal removal;
  removal.parts = std::move(parts);
  removal.attempt = &answer;
  removal.up = up;
  removal.planner = kOwn;
  return removal;
}

namespace {

bool same_pose(const Pose& a, const Pose& b) {
  constexpr double kSamePlace = 1e-9;  // assembly units, and in radians
  const Pose off = a.inverse() * b;
  return off.t.norm() <= kSamePlace && off.q.vec().norm() <= kSamePlace;
}

/// Are these the parts, each moved by `shift`?
bool moved_by(const Pose& shift, const std::vector<PlacedPart>& from, const std::vector<PlacedPart>& to) {
  return std::equal(from.begin(), from.end(), to.begin(), to.end(), [&](const PlacedPart& a, const PlacedPart& b) {
    return a.part == b.part && same_pose(shift * a.pose, b.pose);
  });
}

/// A forced step of a group that has left to another place: the same motion there, with what was said of it.
Removal forced_elsewhere(const Removal& planned, const Attempt& attempt, const Pose& shift, OrderScene& scene) {
  const AttemptResult& then = *planned.attempt;
  ForcingOracle* forcing = scene.oracle.forcing();
  if (forcing == nullptr || !moved_by(shift, then.attempt.moving, attempt.moving) ||
      !moved_by(shift, then.attempt.fixed, attempt.fixed))
    return {};
  Path path;
  for (const auto& poses : then.path()) {
    path.emplace_back();
    for (const Pose& pose : poses) path.back().push_back(shift * pose);
  }
  for (std::size_t i = 0; i < attempt.moving.size(); ++i) path.front()[i] = attempt.moving[i].pose;
  // A proof about the arrangement of that time is none for this one.
  const Certificate* proof = then.forced->cut.certificate.get();
  if (proof != nullptr && !proof->poses.empty()) proof = nullptr;
  std::vector<Unsolved> said;
  for (const PartId id : planned.parts)
    said.push_back({id, Outcome::exhausted, {}, {}, then.forced->cut.reason, proof});
  Removal removal = planned;
  removal.attempt = &forcing->propose_forced(attempt, path, std::nullopt, said, scene.context);
  return removal;
}

}  // namespace

void drop_what_is_elsewhere(const std::vector<Removal>& before, const Disassembly& done, const SequenceQuery& query,
                            SequenceResult& result) {
  const auto is_elsewhere = [&](const Certificate* proof) {
    if (proof->poses.empty()) return false;  // about parts as assembled
    for (std::size_t k = 0; k <= done.steps().size(); ++k) {
      std::size_t there = 0;
      while (there < proof->parts.size() && same_pose(done.pose(proof->parts[there], k), proof->poses[there])) ++there;
      if (there == proof->parts.size()) return false;
    }
    return true;
  };
  std::erase_if(result.proofs, is_elsewhere);
  Disassembly first(query.assembly.parts.size(), query.start);
  for (const Removal& removal : before) first.add(step_of(removal));
  for (Unsolved& u : result.unsolved) {
    if (u.certificate != nullptr && is_elsewhere(u.certificate)) u.certificate = nullptr;  // the engine proves anew
    if (!same_pose(first.pose(u.part), done.pose(u.part))) u.best_pose.clear();
  }
}

Removal verified(const Step& step, const Disassembly& now, OrderScene& scene, std::vector<PartId>& blocked_by) {
  const Motion* motion = step.segment == nullptr ? nullptr : &step.segment->motion(step.variant);
  const Removal* planned = motion == nullptr ? step.planned : motion->planned;
  Removal removal;
  removal.parts = motion == nullptr ? planned->parts : motion->parts;
  removal.up = motion == nullptr ? planned->up : step.segment->up(step.variant);
  Attempt attempt{now.placed(removal.parts),
                  now.placed(without(now.groups()[now.group(removal.parts.front())], removal.parts))};
  if (planned != nullptr && same_places(planned->attempt->attempt.moving, attempt.moving) &&
      same_places(planned->attempt->attempt.fixed, attempt.fixed)) {
    removal.attempt = planned->attempt;
    removal.planner = planned->planner;
    return removal;
  }
  if (planned != nullptr) attempt.goal = planned->attempt->attempt.goal;
  // Parts of a group that has left are elsewhere than in the first plan: the path moves with them.
  const PlacedPart& first = attempt.moving.front();
  const auto& from = planned != nullptr ? planned->attempt->attempt.moving : step.segment->start();
  const auto then = std::find_if(from.begin(), from.end(), [&](const PlacedPart& p) { return p.part == first.part; });
  const Pose shift = first.pose * then->pose.inverse();
  if (planned != nullptr && planned->attempt->forced) return forced_elsewhere(*planned, attempt, shift, scene);
  Path path;
  Eigen::Vector3d out;
  if (motion != nullptr && motion->direction) {
    out = shift.q * scene.directions.all[*motion->direction];
    path.emplace_back();
    for (const PlacedPart& p : attempt.moving) path.front().push_back(p.pose);
  } else {
    for (const auto& poses : planned->attempt->path()) {
      path.emplace_back();
      for (const Pose& pose : poses) path.back().push_back(shift * pose);
    }
    for (std::size_t i = 0; i < attempt.moving.size(); ++i) path.front()[i] = attempt.moving[i].pose;
    out = motion == nullptr ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : Eigen::Vector3d(shift.q * -motion->insertion);
  }
  if (scene.sweep != nullptr && !out.isZero()) go_on(attempt, out, scene, path);
  const AttemptResult& answer = scene.oracle.propose(attempt, path, scene.context);
  blocked_by = answer.result.blocked_by;
  if (!is_success(answer.result.outcome())) return {};
  removal.attempt = &answer;
  removal.planner = planned == nullptr ? kOwn : planned->planner;
  return removal;
}

}  // namespace dismantle::order
