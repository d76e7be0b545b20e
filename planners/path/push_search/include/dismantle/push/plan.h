/// Contact search: answers a path query by push searches in one or both motion spaces.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "dismantle/path_planner.h"
#include "dismantle/push/search.h"
#include "dismantle/push/tactics.h"

namespace dismantle::push {

/// Capabilities that the simulator must have.
Capabilities required();
/// True if the query's simulator has these capabilities and can move all parts of the query.
bool fits(const PathQuery& query);

/// Searches by translation and by rotation in turns of growing rank, until both are exhausted. So states of low rank in
/// one motion space come before states of high rank in the other.
class ByTurns {
 public:
  /// All arguments outlive this.
  ByTurns(const PathQuery& query, const Tactics& tactics, RunContext& context);

  /// Continues where the last call stopped. Ignores Limits::rank. Outcome `depth_limit`: paused.
  PathResult run(const Search::Limits& limits);
  bool paused() const { return paused_; }
  /// The search trees of both.
  std::shared_ptr<const Reached> reached() const;

 private:
  const PathQuery& query_;
  const Tactics& tactics_;
  RunContext& context_;
  Search translation_;
  std::optional<Search> rotation_;
  PathResult first_, second_;  ///< last results of translation and of rotation
  unsigned rank_ = 0;
  bool turning_ = false;             ///< the current turn is that of rotation
  std::optional<bool> screw_first_;  ///< a turn for screws comes first; set by the first run(), false after that turn
  bool paused_ = false;
};

/// Searches in the motion space that the tactics name. With `motion: auto`, searches by translation and by rotation: in
/// turns of growing rank until both are exhausted or, under a depth limit, one after the other, each with a limited
/// number of states. Resumes from PathQuery::resume_from if that is a Reached.
class ContactSearch final : public PathSearch {
 public:
  /// All arguments outlive this. `between`: see Search::Limits; may be empty.
  ContactSearch(const PathQuery& query, const Tactics& tactics, RunContext& context,
                std::function<void()> between = {});

  SearchStatus run(const Budget& portion) override;
  PathResult result() override;

 private:
  /// The search in one motion space, with its limits.
  struct Leg {
    MotionSpace space = MotionSpace::translation;
    unsigned rank = ~0U;
    std::uint64_t expansions = 0;          ///< states, 0 = no limit
    std::optional<std::uint64_t> share{};  ///< most steps that it may use; absent: all that are left
  };
  static std::vector<Leg> legs_of(const PathQuery& query, const Tactics& tactics);
  SearchStatus run_legs(Search::Limits limits);
  SearchStatus run_leg(const Leg& leg, Search::Limits limits);
  void begin_leg(const Leg& leg, Search search);
  void put_screws_first();
  void keep_tree();

  const PathQuery& query_;
  const Tactics& tactics_;
  RunContext& context_;
  std::function<void()> between_;
  Deadline deadline_;
  std::uint64_t steps_left_;
  std::optional<ByTurns> turns_;
  std::vector<Leg> legs_;  ///< not finished, the current one first; unused with `turns_`
  std::optional<Search> current_;
  bool asked_for_screws_ = false;
  std::uint64_t share_left_ = 0, share_ = 0;  ///< of the current leg
  bool any_ = false;                          ///< a leg has ended
  PathResult ended_,
      now_;  ///< results: of the legs that have ended; with the current one
  std::shared_ptr<Reached> reached_ = std::make_shared<Reached>();
};

/// A ContactSearch. If the simulator lacks a required capability, a search that has already ended with `unsupported`.
std::unique_ptr<PathSearch> start(const PathQuery& query, const Tactics& tactics, RunContext& context,
                                  std::function<void()> between = {});

}  // namespace dismantle::push
