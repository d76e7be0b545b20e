#include "dismantle/plugin.h"
#include "dismantle/sampling/targetless.h"
#include "dismantle/sampling/tree_planner.h"
#include "mating_vectors.h"

namespace dismantle::mv_t_rrt {
namespace {

struct Parameters : sampling::TreeParameters {
  Parameters() { goal_bias = 0.2; }
  double neighbor_reach = 0.05;
  double merge_angle = 0.01;
  std::int64_t max_vectors = 256;

  static void describe(Schema<Parameters>& s) {
    sampling::describe_tree(s,
                            "Probability of extending a node towards the nearest state outside "
                            "the bounding box of the fixed parts (table 7).");
    s.add("neighbor_reach", &Parameters::neighbor_reach,
          {.unit = "unit",
           .min = 0,
           .doc = "Fixed parts whose boxes are within this distance of the moving part's box are its neighbours. "
                  "Larger: more directions are tried."});
    s.add("merge_angle", &Parameters::merge_angle,
          {.unit = "rad",
           .min = 0,
           .max = 1.5,
           .doc = "Face normals that differ by less are one mating vector. Larger: fewer directions, some of them "
                  "inexact."});
    s.add("max_vectors", &Parameters::max_vectors,
          {.unit = "1", .min = 0, .doc = "Maximum number of mating vectors tried, those of the largest faces first."});
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
