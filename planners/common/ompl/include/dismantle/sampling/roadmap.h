/// A probabilistic roadmap as an OMPL planner.
#pragma once

#include <ompl/base/Planner.h>
#include <ompl/base/goals/GoalSampleableRegion.h>

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "dismantle/sampling/nearest.h"
#include "dismantle/sampling/sampling_problem.h"

namespace dismantle::sampling {

/// PRM (Kavraki, Svestka, Latombe and Overmars 1996): free states are drawn and joined to their nearest neighbours by
/// straight motions where these are free; only milestones of different components are joined. Ends when the start's
/// component holds a state of the goal. Each iteration adds at most one milestone:
/// - as long as the goal has samples left, one of these;
/// - with probability `expansion`, the end of a free motion from a milestone whose motions were mostly blocked and that
/// was
///   seldom expanded (their expansion step), which is how the roadmap gets through narrow passages; every other time
///   one that the start is joined to;
/// - with probability `gaussian` of the rest, a state near an obstacle (Boor, Overmars and van der Stappen 1999);
/// - else a uniform one.
///
/// Not ompl::geometric::PRM: that runs threads of its own, draws its seeds from a sequence of the whole process, and is
/// not the same from run to run. All random numbers come from the generator given. solve() again goes on with the same
/// roadmap.
class Roadmap final : public ompl::base::Planner {
 public:
  using StateType = SamplingProblem::StateType;
  struct Settings {
    std::size_t neighbours = 8;
    double range = 1;  ///< of expansions, and deviation of the Gaussian; assembly units
    double expansion = 0.3;
    double gaussian = 0.3;
  };

  Roadmap(SamplingProblem& problem, const Settings& settings, const Rng& rng);

  ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition& stop) override;
  void clear() override;

  /// The shortest path of the roadmap, from start to goal; empty before a solution was found.
  const std::vector<StateType>& solution() const { return solution_; }
  /// The motion from state `edge` - 1 to `edge` of the solution is used no more.
  void discard(std::size_t edge);
  std::uint64_t nodes() const { return milestones_.size(); }
  std::uint64_t iterations() const { return iterations_; }
  /// Of what the start is joined to, the milestone whose centre is furthest from it. Nothing: not begun.
  std::optional<StateType> farthest() const;

 private:
  struct Milestone {
    StateType state;
    bool goal = false;
    std::uint32_t component = 0;                            ///< parent in the forest of components
    std::uint32_t tried = 0, blocked = 0;                   ///< motions from here
    std::uint32_t expanded = 0;                             ///< of these, expansions
    std::vector<std::pair<std::uint32_t, double>> edges{};  ///< to, length
  };
  /// Of a component, kept at its root (Milestone::component).
  struct Component {
    std::vector<std::uint32_t> members;
    std::uint32_t goals = 0;  ///< members that are in the goal
  };
  /// One component of two. Roots are the lower: that of the start is 0.
  void merge(std::uint32_t a, std::uint32_t b);
  std::uint32_t component(std::uint32_t node);
  void join(std::uint32_t a, std::uint32_t b);
  std::uint32_t add(const StateType& state);
  void connect(std::uint32_t node);
  /// A milestone of this iteration. Nothing: the state drawn was not free.
  std::optional<std::uint32_t> sample(const ompl::base::GoalSampleableRegion& goal);
  std::optional<std::uint32_t> expand();
  std::optional<StateType> near_obstacle();
  bool find_path();

  SamplingProblem& problem_;
  Settings settings_;
  Rng rng_;
  std::vector<Milestone> milestones_;
  NearestNodes near_;
  unsigned sampled_ = 0;  // states of the goal
  std::uint64_t iterations_ = 0;
  std::vector<Component> components_;  // by root
  std::vector<StateType> solution_;
  std::vector<std::uint32_t> route_;  // the same, as milestones
};

}  // namespace dismantle::sampling
