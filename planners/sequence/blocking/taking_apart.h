/// One run of the `blocking` planner.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "blocking/blocking.h"
#include "blocking/proofs_ahead.h"
#include "blocking/relations.h"
#include "blocking/slides.h"
#include "blocking/turns.h"

namespace dismantle::blocking {

/// Parts are handled in units: one part, or those that a constraint keeps together, or that nothing can part. A group
/// is what still hangs together; it begins with all units, and each removal splits one group in two.
class TakingApart {
 public:
  TakingApart(const BlockingParams& params, const Assembly& assembly, PathOracle& oracle, SequenceObserver& observer,
              RunContext& context);
  SequenceResult run();

 private:
  using UnitId = std::size_t;
  struct Group {
    std::vector<UnitId> units;  ///< in the order in which they are tried
    bool first = false;         ///< what is left of the whole
    bool slides_done = false;   ///< the search for slides has nothing more to offer for these units at these places
    bool groups_done = false;   ///< likewise groups
    bool turns_done = false;    ///< likewise turns
    unsigned at_once = 0;       ///< rounds in which parts were moved at once, each in its own way, in vain
    unsigned depth = 1;         ///< of searches by simulation; the effort of the search for slides grows with it
    bool slides_cut = false;    ///< it ended for want of effort
    bool no_slides = false;     ///< it saw all places, and nobody leaves
    bool searched_out = false;  ///< more depth does not help, or is not allowed
    unsigned pair_depth = 1;    ///< pairs only: doubled with every round
    bool pair_done = false;
    bool searches_done = false;   ///< those that were put off as well
    std::vector<UnitId> waiting;  ///< those whose searches ended for want of depth, as they will be searched next
    std::string slides_said;      ///< why the search for slides found nothing
    std::string at_once_said;     ///< likewise that for motions at once
  };
  /// The last search for the way of a part.
  struct Tried {
    unsigned depth = 0;
    Outcome outcome = Outcome::exhausted;
    std::vector<PartId> blocked_by;
    std::size_t group_size = 0;  ///< when it was made
    const AttemptResult* answer = nullptr;
    Pose pose{};                           ///< of the part, then
    const AttemptResult* after = nullptr;  ///< the one that it was to go on from
  };
  static constexpr UnitId kUnknown = static_cast<UnitId>(-1);
  static constexpr unsigned kDeepestPair = 64;       ///< of the searches for pairs while other pairs wait
  static constexpr std::size_t kAheadPerThread = 4;  ///< attempts that are hinted

  // taking_apart.cpp: order of things, bookkeeping
  void dismantle(Group group);
  bool stop();
  bool may_leave(const Group& group, const std::vector<UnitId>& units) const;
  bool in_group(const Group& group, UnitId unit) const;
  std::vector<PartId> parts_of(const std::vector<UnitId>& units) const;
  Attempt question(const Group& group, const std::vector<UnitId>& units) const;
  void book(Group& group, const std::vector<UnitId>& units, const Attempt& attempt, const AttemptResult& answer);
  void give_up(const Group& group);
  bool unit_locked(UnitId unit) const;
  void tell_locked(UnitId unit);
  SequenceResult finish() const;

  // straight.cpp: by the blocking relations
  bool remove_free_unit(Group& group);
  bool remove_for_target(Group& group);
  bool split(Group& group);
  bool leave(Group& group, const std::vector<UnitId>& units, std::size_t direction);
  void resolve(const Group& group, UnitId unit, std::span<const UnitId> next);
  void hint(const Group& group, std::span<const std::size_t> directions, UnitId unit, std::span<const UnitId> next);
  std::optional<std::size_t> free_direction(const Group& group, UnitId unit, std::span<const UnitId> next = {});
  void hint_if_out(const Group& group, const std::vector<UnitId>& units) const;
  std::vector<Pair> open_questions(const Group& group, UnitId unit, std::size_t direction);
  std::pair<std::optional<UnitId>, std::vector<Pair>> unknown_pairs(const Group& group, UnitId unit,
                                                                    std::size_t direction) const;
  std::vector<Pair> pairs_of(UnitId moving, UnitId still, std::size_t direction) const;
  std::vector<std::size_t> directions_of(UnitId unit) const;
  std::vector<std::size_t> directions_of(const Group& group, UnitId unit) const;
  std::vector<UnitId> in_way_of(const Group& group, UnitId unit, std::size_t direction);
  double way_out(const Group& group, const std::vector<UnitId>& units, std::size_t direction) const;

  // holding.cpp: parts that are proved to hold each other
  bool join_first(Group& group, const std::vector<HoldQuestion>& questions);
  bool join_held(Group& group);
  bool join_flat(Group& group, UnitId unit);
  bool join_flat(Group& group);
  std::vector<HoldQuestion> cage_questions(const Group& group) const;
  std::vector<HoldQuestion> flat_questions(const Group& group) const;
  void add_flat_questions(const Group& group, UnitId unit, std::vector<HoldQuestion>& questions) const;
  bool join_interlocked(Group& group);
  bool join_confined(Group& group);
  bool close_to_proof(const Group& group) const;
  bool join_confined_for_sure(Group& group);
  void add_questions(HoldQuestion::Kind kind, UnitId u, UnitId v, std::vector<HoldQuestion>& questions) const;
  std::optional<UnitId> alone_in_the_way(const Group& group, UnitId unit) const;
  void join_parts(Group& group, const std::vector<PartId>& parts, const Certificate& proof);
  void join(Group& group, UnitId u, UnitId v);
  bool passes_straight(PartId a, PartId b);

  // turning.cpp: parts that are turned where they are
  bool turn(Group& group);
  bool turn(Group& group, UnitId unit, const TurningAxis& axis);
  bool turns_to(Group& group, UnitId unit, const Path& way);
  std::optional<std::pair<UnitId, std::size_t>> freed_by(const Group& group, UnitId unit);
  bool arc_passes(PartId part, const Pose& from, const Pose& to, PartId still);
  bool turns_clear(const Group& group, UnitId unit, const Pose& from, const Pose& to);

  // together.cpp: several parts at once, each in its own way
  bool together(Group& group);
  bool together(Group& group, const std::vector<UnitId>& units, const std::vector<std::vector<UnitId>>& next);
  std::vector<std::vector<UnitId>> interlocked(const Group& group);
  std::optional<Attempt> question_at_once(const Group& group, const std::vector<UnitId>& units) const;
  bool worth_moving(const Group& group, const std::vector<UnitId>& units) const;

  // searching.cpp: where no straight motion exists
  bool slide(Group& group);
  bool shift(Group& group, const std::vector<UnitId>& units, const Eigen::Vector3d& by, const AttemptResult*& answer);
  bool search(Group& group);
  bool search_pair(Group& group, bool others_wait);
  unsigned depth_tried(const Group& group) const;
  unsigned next_depth_of_pair(const Group& group, bool others_wait) const;
  bool make_up_for(Group& group);
  std::vector<UnitId> searchable(const Group& group);
  UnitId housing_of(const Group& group) const;
  void sort_by_use(const Group& group, std::vector<UnitId>& units);
  int cost_of(PartId part, const PathResult& result) const;
  void cheap_first(std::vector<UnitId>& units, unsigned depth) const;
  bool attempt_all(Group& group, const std::vector<UnitId>& units, unsigned depth);
  Attempt search_question(const Group& group, UnitId unit, unsigned depth) const;
  bool attempt(Group& group, UnitId unit, unsigned depth, const std::vector<UnitId>& next);
  bool wants_depth(UnitId unit) const;
  void note_waiting(Group& group, const std::vector<UnitId>& units) const;

  // ahead.cpp: what will probably be asked, for idle threads
  void prefetch(const Group& group, const Attempt& now, const std::vector<UnitId>& next) const;
  void add_waiting(const Group& group, unsigned depth, const std::vector<UnitId>& units,
                   std::vector<Attempt>& ahead) const;
  void add_others(std::vector<Attempt>& ahead) const;
  void drop_hints_if_in(const Group& group, const Attempt& now) const;
  bool likely_to_leave(const Group& group, const Attempt& now) const;
  std::vector<Attempt> next_if_not(const Group& group, const Attempt& now, const std::vector<UnitId>& next) const;
  std::vector<Attempt> next_if_out(const Group& group, const Attempt& now) const;
  std::vector<Attempt> next_searches(const Group& group) const;
  void add_round(const Group& group, std::vector<Attempt>& ahead) const;
  void add_next_round(const Group& group, std::vector<Attempt>& ahead) const;
  bool other_pairs_wait() const;
  void add_searches(const Group& group, unsigned depth, const std::vector<UnitId>& units,
                    std::vector<Attempt>& ahead) const;
  const Certificate* proved(const Group& group, const HoldQuestion& question, std::span<const HoldQuestion> next);
  bool known_to_block(PartId a, PartId b) const;
  void seek_cages(const Group& group) const;
  std::vector<HoldQuestion> likely_proofs(const Group& now) const;
  bool worth_trying(const Group& group, UnitId unit, unsigned depth) const;
  unsigned deepest(const Group& group) const;

  const BlockingParams& params_;
  const Assembly& assembly_;
  PathOracle& oracle_;
  SequenceObserver& observer_;
  RunContext& context_;
  std::vector<std::vector<PartId>> units_;
  std::vector<UnitId> unit_of_;      // by part
  std::vector<bool> locked_;         // by part: into another of its unit
  std::map<PartId, Unsolved> held_;  // of those: held by another without overlap, and why
  std::set<HoldQuestion> asked_;     // or not worth asking
  std::map<HoldQuestion::Kind, std::size_t> proofs_;
  std::set<std::vector<PartId>> interlocked_;  // three and more that were asked about
  std::unique_ptr<ProofsAhead> proofs_ahead_;  // null without a judge
  std::vector<Pose> poses_;                    // by part
  std::vector<std::size_t> turn_;              // by part: the rotation in poses_, as relations_ names it
  std::deque<Group> groups_;                   // waiting
  std::vector<Removal> removals_;
  std::size_t out_ = 0;  // removals that parted a group; one less than units, when all are apart
  std::vector<Unsolved> unsolved_;
  std::vector<PartId> remaining_;
  bool crashed_ = false, interrupted_ = false, target_out_ = false;
  Outcome worst_ = Outcome::solved;
  std::map<std::string, double> counts_;

  Directions directions_;
  std::unique_ptr<Relations> relations_;                // null without a judge
  std::vector<std::map<std::size_t, UnitId>> watched_;  // by unit, by direction: one that is in the way
  std::set<std::pair<std::vector<PartId>, std::size_t>>
      refused_;  // ways that the judge refused, for the group as it is
  SlideSearch slides_;
  std::map<PartId, std::vector<TurningAxis>> axes_;             // where first asked for
  std::set<std::pair<std::vector<UnitId>, std::size_t>> vain_;  // turns that freed nobody after all: group, where to
  std::size_t turn_questions_ = 0;                              // to the judge, for the group as it is
  std::map<std::vector<double>, bool> arcs_;                    // asked about: two parts, and the three poses
  std::map<PartId, Tried> tried_;
  std::map<PartId, int> cost_;  ///< of the last search for a way of this part: about its logarithm
  std::map<std::vector<UnitId>, Tried> tried_at_once_;
  std::set<std::vector<UnitId>> moved_at_once_;  // of those: more than one part moved
  bool none_at_once_ = false;                    // the path planner or the simulator cannot
  std::map<PartId, Unsolved> said_;              // by part: the last that was said
};

}  // namespace dismantle::blocking
