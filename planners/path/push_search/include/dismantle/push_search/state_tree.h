/// The states that a push search has reached, and those that wait for their next actions.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "dismantle/path/state_set.h"
#include "dismantle/plugin/search_recorder.h"
#include "dismantle/push_search/problem.h"
#include "dismantle/push_search/reached.h"

namespace dismantle::push {

/// Best first: the rank of a state grows with the number of similar states that were expanded and with the number of
/// stages of actions that it has had. States of equal rank are expanded in order of depth, those in the middle of
/// translating runs last.
class StateTree {
 public:
  /// `problem` outlives this.
  StateTree(const Problem& problem, const RunContext& context);

  void clear();
  /// The work of the search so far, for its record.
  void note_work(std::uint64_t work) { work_ = work; }
  /// Adds a state with velocity zero. It does not wait yet.
  std::int32_t add(std::int32_t parent, unsigned depth, const State& state, Path motion, bool middle);
  /// The state waits for its next stage, if it is not too deep.
  void enqueue(std::int32_t node);
  /// Takes the state of the least rank. Nothing if no state waits, or none of a rank up to `most`.
  std::optional<std::int32_t> take(unsigned most);
  /// The next stage of a state. Its place counts as expanded from then on.
  std::size_t begin_stage(std::int32_t node);
  /// A run that made no progress since this state ended here.
  void end_run_at(std::int32_t node);
  /// Adds parts that were touched where a run ended in this state; ascending.
  void note_touched(std::int32_t node, const std::vector<PartId>& parts);

  /// Keeps a state in the middle of a translating run for later, if there are not too many yet.
  void keep_middle(std::int32_t from, unsigned depth, const State& state, const Path& motion);
  /// Enqueues the states kept in the middle of runs. False if no state waits.
  bool take_up_middles();

  /// Begins with the nodes of `tree`. Those where runs ended at parts in `absent` (ascending) are new again, the others
  /// keep the stages that they have had.
  void restore(const Tree& tree, const std::vector<PartId>& absent);
  /// Writes nodes and middles.
  void save(Tree& tree) const;

  bool waits() const { return !waiting_.empty(); }
  bool depth_limited() const { return beyond_limit_ > 0; }  ///< states were too deep to be expanded
  std::uint32_t size() const { return static_cast<std::uint32_t>(nodes_.size()); }
  const Node& operator[](std::int32_t node) const { return nodes_[static_cast<std::size_t>(node)]; }
  Node& operator[](std::int32_t node) { return nodes_[static_cast<std::size_t>(node)]; }
  /// All instants from the start to a state.
  Path path_to(std::int32_t node) const;
  const path::StateSet& seen() const { return seen_; }  ///< all states, at the paper's resolution
  const path::StateSet& fine() const { return fine_; }  ///< all states, at a finer resolution
  /// The poses of the largest displacement.
  const std::vector<Pose>& farthest() const { return farthest_; }

 private:
  unsigned rank(const Node& node) const;

  struct Waiting {
    unsigned rank, depth;
    std::int32_t node;
    auto operator<=>(const Waiting&) const = default;
  };

  const Problem& problem_;
  SearchRecord record_;
  std::uint64_t work_ = 0;
  path::StateSet seen_, fine_;
  path::StateSet places_;  ///< expanded states, at a coarser resolution
  std::vector<Node> nodes_;
  std::set<Waiting> waiting_;
  std::size_t beyond_limit_ = 0;
  std::vector<Middle> middles_;
  std::size_t middles_before_ = 0;
  double displacement_ = -1;  ///< of `farthest_`
  std::vector<Pose> farthest_;
};

}  // namespace dismantle::push
