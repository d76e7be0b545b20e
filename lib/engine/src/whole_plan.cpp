#include "whole_plan.h"

#include <algorithm>
#include <iterator>

#include "dismantle/part_set.h"

namespace dismantle {

namespace {

StepQuestion with_present(StepQuestion question, const std::vector<PlacedPart>& list) {
  return {question.assembly, question.moving, list, question.direction, question.path, question.up, question.previous};
}

}  // namespace

WholePlan::WholePlan(const Disassembly& done, const Assembly& assembly, const Eigen::Vector3d& up) {
  const std::vector<DisassemblyStep>& steps = done.steps();
  std::vector<std::vector<PlacedPart>*> built(done.groups().size(), nullptr);  // by group: its list
  std::vector<std::size_t> most(done.groups().size(), 0);                      // parts that a group ever has
  for (std::size_t g = 0; g < most.size(); ++g) most[g] = done.groups()[g].size();
  for (std::size_t k = 0; k < steps.size(); ++k) most[done.left_group(k)] += steps[k].leaving().size();
  for (std::size_t k = steps.size(); k-- > 0;) {
    const std::size_t group = done.left_group(k);
    const std::vector<PlacedPart> moved = done.placed(steps[k].parts, k);
    const auto moves = [&](const PlacedPart& p) { return contains(steps[k].parts, p.part); };
    if (built[group] == nullptr) {
      built[group] = new_list(most[group]);
      for (const PartId id : done.groups()[group]) built[group]->push_back({id, done.pose(id)});
    }
    if (steps[k].leaving().size() < steps[k].parts.size()) {  // parts that stay were elsewhere before
      std::vector<PlacedPart>* before = new_list(most[group]);
      std::remove_copy_if(built[group]->begin(), built[group]->end(), std::back_inserter(*before), moves);
      built[group] = before;
    }
    operations_.emplace_back(assembly, moved, std::vector<PlacedPart>{}, *steps[k].path, steps[k].up.value_or(up));
    alone_.push_back(with_present(operations_.back().question(), *built[group]));
    all_.push_back(with_present(operations_.back().question(alone_.size() > 1 ? &alone_[alone_.size() - 2] : nullptr),
                                *built[group]));
    built[group]->insert(built[group]->end(), moved.begin(), moved.end());
  }
}

std::vector<PlacedPart>* WholePlan::new_list(std::size_t capacity) {
  lists_.emplace_back().reserve(capacity);
  return &lists_.back();
}

}  // namespace dismantle
