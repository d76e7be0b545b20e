/// A small assembly with the simulator sdf_penalty and the verifier as its judge.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "dismantle/path_planner.h"
#include "dismantle/registry.h"
#include "dismantle/verify/verifier.h"
#include "solids.h"

namespace dismantle::path::test {

inline const Registry& registry() {
  static const std::unique_ptr<Registry> all = [] {
    auto r = std::make_unique<Registry>();
    r->scan();
    return r;
  }();
  return *all;
}

struct Table {
  Assembly assembly;
  std::shared_ptr<Simulator> simulator = registry().create<Simulator>("sdf_penalty");
  std::shared_ptr<const Prepared> prepared;
  Verifier verifier;
  std::size_t judged = 0;

  explicit Table(Assembly a) : assembly(std::move(a)), verifier(assembly, {}) {
    RunContext context;
    prepared = simulator->prepare(assembly, context);
  }

  /// Part 0 leaves, by this path planner.
  PathResult plan(const std::string& planner, const ParamSet& given, std::uint64_t seed, std::uint64_t max_steps,
                  unsigned max_depth = 0) {
    Cast cast;
    for (const auto& part : assembly.parts) (part.id == 0 ? cast.moving : cast.still).push_back({part.id, Pose{}});
    RunContext context;
    context.rng = Rng(seed);
    const PathQuery query{
        assembly, *simulator, *prepared, cast, {.max_depth = max_depth, .max_steps = max_steps}, [&](const Path& path) {
          ++judged;
          const MotionCheck check = verifier.check_motion({0}, cast.still, path);
          Verdict v;
          v.accepted = check.valid && verifier.apart({{0, path.back()[0]}}, cast.still);
          if (check.violation) {
            v.has_witness = true;
            v.part = check.violation->part;
            v.other = check.violation->other;
            v.point = check.violation->point;
            v.instant = check.violation->segment;
          }
          return v;
        }};
    return registry().create<PathPlanner>(planner, given)->plan(query, context);
  }
};

}  // namespace dismantle::path::test
