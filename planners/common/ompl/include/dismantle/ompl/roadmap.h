/// A probabilistic roadmap as an OMPL planner.
#pragma once

#include <ompl/base/Planner.h>
#include <ompl/base/goals/GoalSampleableRegion.h>

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "dismantle/ompl/nearest.h"
#include "dismantle/ompl/sampling_problem.h"

namespace dismantle::sampling {

/// PRM (Kavraki, Svestka, Latombe and Overmars 1996): free states are drawn and connected to their nearest neighbours
/// by free straight motions; only milestones of different components are connected. Ends when the start's component
/// holds a state of the goal. Each iteration adds at most one milestone:
/// - a sample of the goal, as long as there are any;
/// - with probability `expansion`, the end of a free motion from a rarely expanded milestone whose motions were mostly
///   blocked (their expansion step), which leads through narrow passages. Half of the expansions begin at a milestone
///   connected to the start;
/// - with probability `gaussian` of the rest, a state near an obstacle (Boor, Overmars and van der Stappen 1999);
/// - otherwise a uniform one.
///
/// Not ompl::geometric::PRM, which runs its own threads, draws its seeds from a process-wide sequence, and is not
/// reproducible. All random numbers come from the given generator. A further solve() continues with the same roadmap.
class Roadmap final : public ompl::base::Planner {
 public:
  using StateType = SamplingProblem::StateType;
  struct Settings {
    std::size_t neighbours = 8;
    double range = 1;  ///< longest expansion, and deviation of the Gaussian; assembly units
    double expansion = 0.3;
    double gaussian = 0.3;
  };

  Roadmap(SamplingProblem& problem, const Settings& settings, const Rng& rng);

  ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition& stop) override;
  void clear() override;

  /// The shortest path of the roadmap, from start to goal; empty before a solution was found.
  const std::vector<StateType>& solution() const { return solution_; }
  /// Removes the motion from state `edge` - 1 to `edge` of the solution.
  void discard(std::size_t edge);
  std::uint64_t nodes() const { return milestones_.size(); }
  std::uint64_t iterations() const { return iterations_; }
  /// Of the milestones connected to the start, the one whose centre is furthest from it. Nothing before the first
  /// solve().
  std::optional<StateType> farthest() const;

 private:
  struct Milestone {
    StateType state;
    bool goal = false;
    std::uint32_t component = 0;                            ///< parent in the forest of components
    std::uint32_t tried = 0, blocked = 0;                   ///< number of motions from here
    std::uint32_t expanded = 0;                             ///< number of expansions from here
    std::vector<std::pair<std::uint32_t, double>> edges{};  ///< to, length
  };
  /// Stored at the index of the component's root (Milestone::component).
  struct Component {
    std::vector<std::uint32_t> members;
    std::uint32_t goals = 0;  ///< members that are in the goal
  };
  /// Merges two components. The lower root remains, so the root of the start's component is 0.
  void merge(std::uint32_t a, std::uint32_t b);
  std::uint32_t component(std::uint32_t node);
  void join(std::uint32_t a, std::uint32_t b);
  std::uint32_t add(const StateType& state);
  void connect(std::uint32_t node);
  /// The milestone of this iteration; nothing if it was not free.
  std::optional<std::uint32_t> sample(const ompl::base::GoalSampleableRegion& goal);
  std::optional<std::uint32_t> expand();
  std::optional<StateType> near_obstacle();
  bool find_path();

  SamplingProblem& problem_;
  Settings settings_;
  Rng rng_;
  std::vector<Milestone> milestones_;
  NearestNodes near_;
  unsigned sampled_ = 0;  // goal states drawn
  std::uint64_t iterations_ = 0;
  std::vector<Component> components_;  // by root
  std::vector<StateType> solution_;
  std::vector<std::uint32_t> route_;  // the milestones of solution_
};

}  // namespace dismantle::sampling
