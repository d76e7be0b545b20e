// Resuming from the tree of an earlier search.
#include <algorithm>
#include <iterator>
#include <utility>

#include "dismantle/path/resume.h"
#include "dismantle/push/search.h"

namespace dismantle::push {

Tree Search::tree() const {
  Tree tree;
  tree.fixed = path::fixed_parts(query_.scene);
  tree.nodes = nodes_;
  tree.passed = passed_;
  tree.passed_before = passed_before_;
  tree.relaxed = !may_relax_;
  tree.samples = samples_;
  tree.short_glides = short_glides_;
  return tree;
}

/// A run that ended at parts that are still present would most likely end there again. A run that ended at a part that
/// is absent now may lead further: the state at its end is given all its actions again, like a new state. All other
/// states keep the stages that they have had.
void Search::resume(const Tree& tree) {
  const std::vector<PartId> fixed = path::fixed_parts(query_.scene);
  std::vector<PartId> left;
  std::set_difference(tree.fixed.begin(), tree.fixed.end(), fixed.begin(), fixed.end(), std::back_inserter(left));
  others_left_ = !left.empty();
  if (tree.relaxed) {
    world_->allow_overlap_everywhere();
    may_relax_ = false;
  }
  for (const path::ContactSample& sample : tree.samples) {
    if (std::binary_search(left.begin(), left.end(), sample.part) ||
        std::binary_search(left.begin(), left.end(), sample.other))
      continue;
    world_->add_contact_sample(sample.part, sample.other, sample.point);
    samples_.push_back(sample);
  }
  short_glides_ = tree.short_glides;
  clear();
  for (const Node& known : tree.nodes) {
    const std::int32_t id = add_node(known.parent, known.depth, known.state, known.way, known.middle);
    Node& node = nodes_[static_cast<std::size_t>(id)];
    std::set_difference(known.touched.begin(), known.touched.end(), left.begin(), left.end(),
                        std::back_inserter(node.touched));
    for (const PartId part : node.touched) ++touched_[part];
    const bool freed = node.touched.size() < known.touched.size();
    node.may_wait = known.may_wait || freed;
    if (freed) continue;
    node.stage = known.stage;
    node.work = known.work;
    if (node.stage > 0) places_.add(node.state, 0);
    kept_ += node.stage;
    spared_ += node.work;
  }
  resumed_ = nodes_.size();
  for (std::size_t id = 0; id < nodes_.size(); ++id)  // ranks depend on all expanded states
    if (nodes_[id].may_wait && nodes_[id].stage < stages_.size()) enqueue(static_cast<std::int32_t>(id));
  passed_ = tree.passed;
  passed_before_ = tree.passed_before;
}

/// States of the resumed tree that are separated now that other parts have left. Those with the fewest actions come
/// first; no more than the verifier may refuse.
std::vector<std::int32_t> Search::out_by_now() {
  std::vector<std::int32_t> all;
  if (!std::exchange(others_left_, false)) return all;
  for (std::size_t id = 1; id < nodes_.size(); ++id)
    if (out(nodes_[id].state)) all.push_back(static_cast<std::int32_t>(id));
  const auto depth = [&](std::int32_t id) { return nodes_[static_cast<std::size_t>(id)].depth; };
  std::stable_sort(all.begin(), all.end(), [&](std::int32_t a, std::int32_t b) { return depth(a) < depth(b); });
  all.resize(std::min(all.size(), static_cast<std::size_t>(tactics_.max_refusals)));
  return all;
}

}  // namespace dismantle::push
