#include "dismantle/ompl/roadmap.h"
#include "dismantle/ompl/start_and_goals.h"
#include "dismantle/plugin.h"

namespace dismantle::prm {
namespace {

using sampling::Roadmap;
using sampling::SamplingProblem;

struct Parameters : sampling::SpaceParameters {
  std::int64_t goals = 20;
  std::int64_t neighbours = 8;
  /// Probability of expanding a milestone whose motions were mostly blocked, instead of sampling. Larger: more work in
  /// narrow passages.
  double expansion = 0.3;
  double gaussian = 0.3;  ///< Share of the samples that are drawn near obstacles; the others are uniform.

  static void describe(Schema<Parameters>& s) {
    sampling::describe_motion(s);
    s.add("goals", &Parameters::goals,
          {.unit = "1",
           .min = 1,
           .max = 1e6,
           .doc = "Disassembled states that the roadmap begins with: the six nearest exits, then random states."});
    s.add("neighbours", &Parameters::neighbours,
          {.unit = "1",
           .min = 1,
           .max = 1000,
           .doc = "Nearest milestones to which connections from a new one are tried. More: paths are found with fewer "
                  "milestones, but each milestone costs more state checks."});
    s.advanced("expansion", &Parameters::expansion, {0, 1});
    s.advanced("gaussian", &Parameters::gaussian, {0, 1});
    sampling::describe_space(s, "Longest extension of a milestone, and deviation of the samples near obstacles.");
  }
};

class Prm final : public PathPlanner {
 public:
  explicit Prm(const Parameters& parameters) : parameters_(parameters) {}
  PathPlannerTraits traits() const noexcept override { return {.needs = sampling::kSpaceNeeds}; }
  std::unique_ptr<PathSearch> start(const PathQuery& query, RunContext& context) override {
    return sampling::start_search(
        query, context, parameters_, [p = parameters_](SamplingProblem& problem, const Rng& rng) {
          const Roadmap::Settings settings{static_cast<std::size_t>(p.neighbours), p.range, p.expansion, p.gaussian};
          return std::make_unique<sampling::StartAndGoals<Roadmap>>(problem, p.goals, settings, rng);
        });
  }

 private:
  Parameters parameters_;
};

}  // namespace
}  // namespace dismantle::prm

DISMANTLE_PLUGIN("dismantle.prm", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::PathPlanner, dismantle::prm::Prm, dismantle::prm::Parameters>(
      "prm", "Probabilistic roadmap that joins the start to disassembled states.",
      {.source = "Kavraki, Svestka, Latombe and Overmars 1996", .needs = dismantle::sampling::kSpaceNeeds});
}
