/// Contact search: a path planner's searches over pushes.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "dismantle/path_planner.h"
#include "dismantle/push/search.h"
#include "dismantle/push/tactics.h"

namespace dismantle::push {

/// What the simulator has to be capable of.
Capabilities required();
/// The query's simulator is capable of it.
bool fits(const PathQuery& query);

/// Search by translation and by rotation in turns of growing rank, until both are exhausted: what is new to each kind
/// of motion comes before the rest of the other.
class ByTurns {
 public:
  /// All three outlive this.
  ByTurns(const PathQuery& query, const Tactics& tactics, RunContext& context);

  /// Goes on where the last call stopped; Limits::rank is its own affair. `depth_limit`: it was paused.
  PathResult run(const Search::Limits& limits);
  bool paused() const { return paused_; }
  /// What both have reached.
  std::shared_ptr<const Reached> reached() const;

 private:
  const PathQuery& query_;
  const Tactics& tactics_;
  RunContext& context_;
  Search translation_;
  std::optional<Search> rotation_;
  PathResult first_, second_;  ///< what each said last
  unsigned rank_ = 0;
  bool turning_ = false;             ///< whose turn it is
  std::optional<bool> screw_first_;  ///< asked for when run() is called first; false once that turn is over
  bool paused_ = false;
};

/// Searches in the motion space that the tactics name, or, with `motion: auto`,
/// by translation and by rotation: in turns of growing rank until both are
/// exhausted; under a depth limit one after the other, with a number of states
/// for each. Resumes from PathQuery::resume_from where that is one of its own.
class ContactSearch final : public PathSearch {
 public:
  /// All outlive this. `between`: see Search::Limits; may be empty.
  ContactSearch(const PathQuery& query, const Tactics& tactics, RunContext& context,
                std::function<void()> between = {});

  SearchStatus run(const Budget& portion) override;
  PathResult result() override;

 private:
  /// One motion space, with its part of the effort.
  struct Leg {
    MotionSpace space = MotionSpace::translation;
    unsigned rank = ~0U;
    std::uint64_t expansions = 0;          ///< states, 0 = no limit
    std::optional<std::uint64_t> share{};  ///< of the steps that are left: at most this number, or all
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
  std::vector<Leg> legs_;  ///< those still to come, the current one first; where
                           ///< there are no turns
  std::optional<Search> current_;
  bool asked_for_screws_ = false;
  std::uint64_t share_left_ = 0, share_ = 0;  ///< of the current leg
  bool any_ = false;                          ///< a leg has ended
  PathResult ended_,
      now_;  ///< of the legs that have ended; with the current one
  std::shared_ptr<Reached> reached_ = std::make_shared<Reached>();
};

/// A search as above, or one that is over because the simulator cannot do what
/// it needs.
std::unique_ptr<PathSearch> start(const PathQuery& query, const Tactics& tactics, RunContext& context,
                                  std::function<void()> between = {});

}  // namespace dismantle::push
