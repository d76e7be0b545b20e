#include "dismantle/ompl/targetless.h"
#include "dismantle/ompl/tree_planner.h"
#include "dismantle/plugin.h"
#include "mating_vectors.h"

namespace dismantle::mv_t_rrt {
namespace {

struct Parameters : sampling::TreeParameters {
  Parameters() { goal_bias = 0.2; }
  /// Fixed parts whose boxes are within this distance of the moving part's box are its neighbours. Larger: more
  /// directions are tried (assembly units).
  double neighbor_reach = 0.05;
  /// Face normals that differ by less are one mating vector. Larger: fewer directions, some of them inexact (rad).
  double merge_angle = 0.01;
  std::int64_t max_vectors = 256;  ///< Maximum number of mating vectors tried, those of the largest faces first.

  static void describe(Schema<Parameters>& s) {
    sampling::describe_tree(s,
                            "Probability of extending a node towards the nearest state outside "
                            "the bounding box of the fixed parts (table 7).");
    s.advanced("neighbor_reach", &Parameters::neighbor_reach, {0});
    s.advanced("merge_angle", &Parameters::merge_angle, {0, 1.5});
    s.advanced("max_vectors", &Parameters::max_vectors, {0});
  }
};

class MatingVectorTargetlessRrt final : public PathPlanner {
 public:
  explicit MatingVectorTargetlessRrt(const Parameters& parameters) : parameters_(parameters) {}
  PathPlannerTraits traits() const noexcept override { return {.needs = sampling::kTreeNeeds}; }
  std::unique_ptr<PathSearch> start(const PathQuery& query, RunContext& context) override {
    return sampling::start_trees(
        query, context, parameters_,
        [](sampling::SamplingProblem& problem, Rng) { return std::make_unique<sampling::NearestExit>(problem); },
        [this](const PathQuery& q) {
          return mating_vectors(q, parameters_.neighbor_reach, parameters_.merge_angle,
                                static_cast<std::size_t>(parameters_.max_vectors));
        });
  }

 private:
  Parameters parameters_;
};

}  // namespace
}  // namespace dismantle::mv_t_rrt

DISMANTLE_PLUGIN("dismantle.mv_t_rrt", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::PathPlanner, dismantle::mv_t_rrt::MatingVectorTargetlessRrt, dismantle::mv_t_rrt::Parameters>(
      "mv_t_rrt", "Straight lines along mating vectors, then Targetless-RRT.",
      {.source = "Ebinger et al. 2018; Tian et al. 2022, section 6.1", .needs = dismantle::sampling::kTreeNeeds});
}
