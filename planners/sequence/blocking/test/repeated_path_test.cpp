// Copies of a part leave on its path, and only where that path is valid.
#include <gtest/gtest.h>

#include <string>

#include "run_blocking.h"

namespace dismantle {
namespace {

using Vec3 = Eigen::Vector3d;

/// Blocks in pockets of one housing: each has to go along +x from under a roof, and then up. The `closed` one has
/// a lid over the place where the others go up.
Assembly blocks_in_pockets(const std::vector<Vec3>& places, std::size_t closed) {
  std::vector<fake::Box> housing;
  std::vector<std::pair<std::string, std::vector<fake::Box>>> blocks;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const auto add = [&](const Vec3& lo, const Vec3& hi) { housing.push_back({places[k] + lo, places[k] + hi}); };
    add({-1, -1, -1}, {4, 1, 0});
    add({-1, -1, 0}, {0, 1, 1.5});
    add({3, -1, 0}, {4, 1, 1.5});
    add({0, -1, 0}, {3, -0.5, 1.5});
    add({0, 0.5, 0}, {3, 1, 1.5});
    add({0, -0.5, 1}, {1.2, 0.5, 1.5});
    if (k == closed) add({1.2, -0.5, 1}, {3, 0.5, 1.5});
    blocks.push_back(
        {"block" + std::to_string(k), {{places[k] + Vec3(0.05, -0.45, 0.05), places[k] + Vec3(1, 0.45, 0.95)}}});
  }
  blocks.insert(blocks.begin(), {"housing", housing});
  return fake::assembly_of(blocks);
}

/// Finds the path of one part, and fails for all others.
fake::Script path_of(PartId part) {
  return [part](const PathQuery& query, RunContext&) {
    if (query.scene.moving.size() != 1 || query.scene.moving[0].part != part) return fake::outcome(Outcome::exhausted);
    const Pose start = query.scene.moving[0].pose;
    const Vec3 aside(1.6, 0, 0), up(0, 0, 20);
    return fake::shown(query, {{start}, {{start.t + aside, start.q}}, {{start.t + aside + up, start.q}}});
  };
}

BlockingParameters searches_only() {
  BlockingParameters params;
  params.translation_states = 0;
  params.groups = params.rotations = params.simultaneous = false;
  return params;
}

TEST(RepeatedPath, CopiesLeaveOnThePathOfTheFirst) {
  Rng rng(2);
  for (int round = 0; round < 5; ++round) {
    const std::size_t n = 3 + static_cast<std::size_t>(round);
    std::vector<Vec3> places;
    for (std::size_t k = 0; k < n; ++k)
      places.push_back({rng.uniform(-1, 1), 2.0 * static_cast<double>(k), rng.uniform(-0.4, 0.4)});
    const Assembly assembly = blocks_in_pockets(places, n);
    const auto first = static_cast<PartId>(1 + rng.below(n));
    const RunResult r = fake::take_apart(assembly, 1, {}, path_of(first), {}, searches_only());
    EXPECT_EQ(r.outcome, Outcome::solved);
    EXPECT_EQ(r.sequence_counts.at("repeated"), static_cast<double>(n - 1));
    BlockingParameters off = searches_only();
    off.repeated_paths = false;
    EXPECT_NE(fake::take_apart(assembly, 1, {}, path_of(first), {}, off).outcome, Outcome::solved);
  }
}

TEST(RepeatedPath, ACopyInAClosedPocketStays) {
  const Assembly assembly = blocks_in_pockets({{0, 0, 0}, {0.3, 2, 0.1}, {0, 4, 0}}, 1);
  const RunResult r = fake::take_apart(assembly, 1, {}, path_of(1), {}, searches_only());
  EXPECT_NE(r.outcome, Outcome::solved);
  EXPECT_EQ(r.sequence_counts.at("repeated"), 1);
  EXPECT_EQ(r.plan.disassembly.size(), 2U);
}

}  // namespace
}  // namespace dismantle
