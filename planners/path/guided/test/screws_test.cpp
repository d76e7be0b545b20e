// Screws and curved slides are undone however the assembly lies, and the verifier agrees.
#include <gtest/gtest.h>

#include <memory>

#include "dismantle/path_planner.h"
#include "dismantle/prepare/prepare.h"
#include "dismantle/registry.h"
#include "dismantle/samples.h"
#include "dismantle/verify/verifier.h"

namespace dismantle::guided {
namespace {

const Registry& registry() {
  static const std::unique_ptr<Registry> all = [] {
    auto r = std::make_unique<Registry>();
    r->scan();
    return r;
  }();
  return *all;
}

/// As `dismantle plan` prepares it; seed 0: as built, otherwise turned at random.
Assembly turned_sample(const std::string& name, ParamSet given, std::int64_t seed) {
  RunContext context;
  PrepareReport report;
  given["rotate_seed"] = seed;
  return prepare_assembly(samples::make(name, given), name, "", PrepareOptions{}, context, report);
}

struct Answer {
  PathResult result;
  MotionCheck check;  ///< of the path returned
};

Answer plan(const Assembly& assembly, const std::string& part, const Effort& effort) {
  const auto simulator = registry().create<Simulator>("sdf_penalty");
  RunContext context;
  const auto prepared = simulator->prepare(assembly, context);
  const Verifier verifier(assembly, {});
  Cast cast;
  for (const Part& p : assembly.parts) (p.name == part ? cast.moving : cast.still).push_back({p.id, Pose{}});
  const std::vector<PartId> moving{cast.moving.at(0).part};
  const PathQuery query{assembly, *simulator, *prepared, cast, effort, [&](const Path& path) {
                          Verdict v;
                          const MotionCheck check = verifier.check_motion(moving, cast.still, path);
                          v.accepted = check.valid;
                          if (check.violation) {
                            v.has_witness = true;
                            v.part = check.violation->part;
                            v.other = check.violation->other;
                            v.point = check.violation->point;
                          }
                          return v;
                        }};
  Answer answer{registry().create<PathPlanner>("guided")->plan(query, context), {}};
  if (is_success(answer.result.outcome)) answer.check = verifier.check_motion(moving, cast.still, answer.result.path);
  return answer;
}

/// Steps of simulation and looks while gliding: several times of what it takes.
constexpr std::uint64_t kSteps = 8'000;

void expect_solved_however_it_lies(const std::string& name, const std::string& part, const ParamSet& given) {
  for (std::int64_t seed = 0; seed < 3; ++seed) {
    const Answer answer = plan(turned_sample(name, given, seed), part, {.max_steps = kSteps});
    ASSERT_EQ(answer.result.outcome, Outcome::solved) << name << ", " << seed << ": " << answer.result.message;
    EXPECT_TRUE(answer.check.valid);
    double turned = 0;
    for (std::size_t k = 1; k < answer.result.path.size(); ++k)
      turned += angle_between(answer.result.path[k - 1][0].q, answer.result.path[k][0].q);
    EXPECT_GT(turned, 0.5) << "it takes a turn";
  }
}

TEST(GuidedScrews, ANutIsUnscrewed) {
  expect_solved_however_it_lies("bolt_and_nut", "nut",
                                {{"turns", 1.0}, {"segments", std::int64_t{32}}, {"clearance", 0.12}});
}
TEST(GuidedScrews, ARingLeavesACurvedTube) {
  expect_solved_however_it_lies("ring_on_curved_tube", "ring", {{"segments", std::int64_t{24}}});
}

}  // namespace
}  // namespace dismantle::guided
