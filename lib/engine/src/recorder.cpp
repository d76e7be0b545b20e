#include "recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <utility>

#include "dismantle/engine/broken_constraint.h"
#include "dismantle/part_set.h"

namespace dismantle {

namespace {

/// The step `last`, which was a placement, followed by `next` of the same parts.
DisassemblyStep joined(const DisassemblyStep& last, DisassemblyStep next) {
  Path path(last.path->begin(), last.path->end() - 1);
  path.insert(path.end(), next.path->begin(), next.path->end());
  next.path = std::make_shared<const Path>(std::move(path));
  next.max_penetration = std::max(next.max_penetration, last.max_penetration);
  next.seconds += last.seconds;
  next.depth += last.depth;
  for (const PartId id : last.contacts)
    if (!contains(next.contacts, id)) next.contacts.push_back(id);
  return next;
}

}  // namespace

Recorder::Recorder(const Assembly& assembly, Oracle& oracle, const PlanningSetup& setup, const RunOptions& options,
                   const StepObserver& on_step, const RunContext& context)
    : assembly_(assembly),
      oracle_(oracle),
      setup_(setup),
      constraints_(options.constraints),
      on_step_(on_step),
      context_(context),
      disassembly_(options.start.empty() ? Disassembly(assembly.parts.size())
                                         : Disassembly(assembly.parts.size(), options.start)) {
  for (PartId id = 0; id < disassembly_.parts(); ++id) poses_.push_back(canonical(disassembly_.pose(id)));
}

void Recorder::update(const std::vector<PartId>& moved) {
  for (const PartId id : moved) poses_[id] = canonical(disassembly_.pose(id));
}

void Recorder::append(DisassemblyStep step) {
  disassembly_.add(std::move(step));
  update(disassembly_.steps().back().parts);
}

void Recorder::pop() {
  const std::vector<PartId> moved = disassembly_.steps().back().parts;
  disassembly_.pop();
  update(moved);
}

void Recorder::record(const Removal& removal, const DisassemblyStep* earlier) {
  if (!problem_.empty()) throw std::logic_error(problem_);  // the planner ignored an earlier error
  try {
    add(removal, earlier);
  } catch (const std::logic_error& e) {
    problem_ = e.what();
    throw;
  }
  oracle_.recorded(*removal.attempt);
  if (!on_step_) return;
  try {
    on_step_(disassembly_, disassembly_.steps().back());
  } catch (const std::exception& e) {  // the run continues; the next step tries again
    context_.log(LogLevel::error, fmt::format("the plan so far could not be passed on: {}", e.what()));
  }
}

void Recorder::add(const Removal& removal, const DisassemblyStep* earlier) {
  check_question(removal);
  DisassemblyStep step = to_step(removal);
  const std::string broken =
      broken_constraint(step, disassembly_.groups()[*disassembly_.common_group(step.parts)], constraints_);
  if (!broken.empty()) throw std::logic_error("a removal against a constraint: " + broken);
  if (earlier != nullptr) {
    step.seconds = earlier->seconds;
    step.depth = earlier->depth;
    step.planner = earlier->planner;
    step.contacts = earlier->contacts;
  }
  std::optional<DisassemblyStep> replaced;
  if (continues_last(step)) {
    replaced = disassembly_.steps().back();
    step = joined(*replaced, std::move(step));
    pop();
  }
  append(std::move(step));
  if (earlier != nullptr)
    before_.clear();
  else
    before_.push_back(std::move(replaced));
}

bool Recorder::taken_back(std::size_t count) {
  if (count > before_.size()) return false;
  for (; count > 0; --count) {
    pop();
    if (before_.back()) append(std::move(*before_.back()));
    before_.pop_back();
  }
  return true;
}

void Recorder::check_question(const Removal& removal) const {
  if (!oracle_.answered(removal.attempt) || !removal.attempt->removes())
    throw std::logic_error("a removal that is not a successful answer of the oracle");
  if (removal.parts.empty()) throw std::logic_error("a removal of no part");
  const std::optional<std::size_t> group = disassembly_.common_group(removal.parts);
  if (!group) throw std::logic_error("the parts of a removal are unknown or not together any more");
  const std::vector<PartId> rest = without(disassembly_.groups()[*group], removal.parts);
  if (rest.empty() && !removal.attempt->out) throw std::logic_error("a removal that leaves nothing behind");
  const std::vector<PlacedPart>& moving = removal.attempt->attempt.moving;
  const bool same = std::equal(removal.parts.begin(), removal.parts.end(), moving.begin(), moving.end(),
                               [&](PartId id, const PlacedPart& p) { return p.part == id && p.pose == poses_[id]; });
  if (!same || !oracle_.were_fixed(*removal.attempt, rest, poses_))
    throw std::logic_error("a removal whose path was found for other parts or other places");
}

DisassemblyStep Recorder::to_step(const Removal& removal) const {
  const AttemptResult& answer = *removal.attempt;
  DisassemblyStep step = step_of(removal);
  step.max_penetration = answer.max_penetration;
  step.seconds = answer.seconds;
  step.depth = answer.result.depth;
  const std::string& proposing = removal.planner.empty() ? setup_.sequence_planner_id : removal.planner;
  step.planner = answer.forced ? "forced" : answer.proposed && !proposing.empty() ? proposing : setup_.path_planner_id;
  step.contacts = answer.result.blocked_by;
  if (answer.forced) {
    step.forced = answer.forced->cut;
    step.depth = 1;
    step.contacts = {answer.forced->cut.deepest.other};
  }
  return step;
}

/// Does the step continue the placement of the last one?
bool Recorder::continues_last(const DisassemblyStep& step) const {
  if (disassembly_.steps().empty()) return false;
  const DisassemblyStep& last = disassembly_.steps().back();
  return last.placement && last.parts == step.parts;
}

}  // namespace dismantle
