// Resuming from the tree of an earlier search.
#include <algorithm>
#include <iterator>
#include <utility>

#include "dismantle/path/resume.h"
#include "dismantle/push_search/search.h"

namespace dismantle::push {

Tree Search::tree() const {
  Tree tree;
  tree.fixed = path::fixed_parts(problem_->query.scene);
  tree_.save(tree);
  tree.relaxed = relaxed_;
  tree.samples = verification_.samples();
  tree.short_glides = short_glides_;
  return tree;
}

/// A run that ended at parts that are still present would most likely end there again. A run that ended at a part that
/// is absent now may lead further: the state at its end is given all its actions again, like a new state. All other
/// states keep the stages that they have had.
void Search::resume(const Tree& tree) {
  const std::vector<PartId> fixed = path::fixed_parts(problem_->query.scene);
  std::vector<PartId> absent;
  std::set_difference(tree.fixed.begin(), tree.fixed.end(), fixed.begin(), fixed.end(), std::back_inserter(absent));
  others_left_ = !absent.empty();
  if (tree.relaxed) problem_->world->allow_overlap_everywhere();
  relaxed_ = relaxed_ || tree.relaxed;
  const auto is_absent = [&](PartId part) { return std::binary_search(absent.begin(), absent.end(), part); };
  for (const path::ContactSample& sample : tree.samples)
    if (!is_absent(sample.part) && !is_absent(sample.other)) verification_.learn(sample);
  short_glides_ = tree.short_glides;
  clear();
  tree_.restore(tree, absent);
  for (std::uint32_t id = 0; id < tree_.size(); ++id) {
    const Node& node = tree_[static_cast<std::int32_t>(id)];
    for (const PartId part : node.touched) ++touched_[part];
    resumed_.expanded += node.stage;
    resumed_.spared += node.work;
  }
  resumed_.nodes = tree_.size();
}

/// Verifies the states of the resumed tree that are separated now that other parts have left. Those with the fewest
/// actions come first; no more than the verifier may refuse.
RunEnd Search::verify_resumed(PathResult& result) {
  RunEnd end = RunEnd::blocked;
  if (!std::exchange(others_left_, false)) return end;
  std::vector<std::int32_t> separated;
  for (std::int32_t id = 1; id < static_cast<std::int32_t>(tree_.size()); ++id)
    if (problem_->out(tree_[id].state)) separated.push_back(id);
  std::stable_sort(separated.begin(), separated.end(),
                   [&](std::int32_t a, std::int32_t b) { return tree_[a].depth < tree_[b].depth; });
  separated.resize(std::min(separated.size(), static_cast<std::size_t>(problem_->tactics.max_refusals)));
  for (const std::int32_t id : separated) {
    end = verify(id, id, result);
    if (end == RunEnd::refused_learned) restart();
    if (end == RunEnd::refused_learned || end == RunEnd::solved) break;
  }
  return end;
}

}  // namespace dismantle::push
