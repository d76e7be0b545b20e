/// Puzzles of cubes without play, against a solver that tries everything.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dismantle/testing/shapes.h"
#include "dismantle/testing/voxels.h"
#include "run_blocking.h"

namespace dismantle::blocking {
namespace {

using Vec3 = Eigen::Vector3d;
using Cell2 = std::array<int, 2>;

/// Pieces of random cells that hold each other, and take several moves to the first separation.
struct Puzzle {
  std::vector<voxels::Piece> pieces;
  voxels::Solution truth;
};

Puzzle random_puzzle(Rng& rng, std::size_t count, int least_moves) {
  for (;;) {
    Puzzle puzzle;
    puzzle.pieces.resize(count);
    const double share = rng.uniform(0.4, 0.7);
    for (int x = 0; x < 4; ++x)
      for (int y = 0; y < 4; ++y)
        for (int z = 0; z < 3; ++z)
          if (rng.uniform() < share) puzzle.pieces[rng.below(count)].push_back({x, y, z});
    if (std::any_of(puzzle.pieces.begin(), puzzle.pieces.end(), [](const auto& p) { return p.empty(); })) continue;
    puzzle.truth = voxels::solve(puzzle.pieces, 2'000);
    if (puzzle.truth.moves && *puzzle.truth.moves >= least_moves) return puzzle;
  }
}

/// Where a corner of a box of cells is when the outside is round: nearer to the middle, the more so the farther it is
/// from the middles of the sides. All within the box stays where it is.
Vec3 rounded(const Vec3& p, const Vec3& size, double depth) {
  Vec3 q = p;
  for (int k = 0; k < 3; ++k) {
    const Vec3 from_middle = 2 * p.cwiseQuotient(size) - Vec3::Ones();
    const double aside = 0.5 * (from_middle.squaredNorm() - from_middle[k] * from_middle[k]);
    if (p[k] == 0) q[k] += depth * aside;
    if (p[k] == size[k]) q[k] -= depth * aside;
  }
  return q;
}

Assembly assembly_of(const std::vector<voxels::Piece>& pieces, const Pose& pose, const Vec3& pitch,
                     double roundness = 0) {
  std::vector<Mesh> meshes;
  for (const auto& piece : pieces) {
    Mesh mesh = voxels::surface(piece);
    for (Vec3& v : mesh.vertices) v = pose * rounded(v, {4, 4, 3}, roundness).cwiseProduct(pitch);
    meshes.push_back(std::move(mesh));
  }
  return shapes::assembly_of(meshes);
}

/// Straight slides until the first separation.
int moves_to_first_separation(const Plan& plan) {
  int moves = 0;
  for (const PlanStep& step : plan.disassembly) {
    std::optional<Vec3> last;
    const auto& poses = step.moves.front().poses;
    for (std::size_t k = 0; k + 1 < poses.size(); ++k) {
      const Vec3 displacement = poses[k + 1].t - poses[k].t;
      if (displacement.norm() < 1e-9) continue;
      if (!last || last->dot(displacement.normalized()) < 0.999) ++moves;
      last = displacement.normalized();
    }
    if (!step.separates.empty()) break;
  }
  return moves;
}

TEST(Puzzles, ComeApartInTheLeastNumberOfMoves) {
  Rng rng(31);
  for (int trial = 0; trial < 12; ++trial) {
    const Puzzle puzzle = random_puzzle(rng, 3 + rng.below(2), 3);
    const Vec3 pitch(rng.uniform(0.6, 2), rng.uniform(0.6, 2), rng.uniform(0.6, 2));
    const Assembly assembly = assembly_of(puzzle.pieces, shapes::random_pose(rng, 3), pitch);
    RunOptions options;
    options.verify.max_penetration = 0.002;
    const RunResult result = fake::take_apart(assembly, 1, options);
    EXPECT_EQ(moves_to_first_separation(result.plan), *puzzle.truth.moves) << trial;
    EXPECT_FALSE(result.plan.disassembly.empty());
  }
}

/// A run that is stopped after the search over arrangements spent its budget says what was visited, and what waits.
TEST(Puzzles, AStoppedRunSaysHowManyArrangementsWait) {
  // Four cubes that change places in a closed frame.
  std::vector<voxels::Piece> pieces(1);
  for (int x = -1; x < 5; ++x)
    for (int y = -1; y < 5; ++y)
      for (int z = -1; z < 2; ++z)
        if (x < 0 || y < 0 || z != 0 || x > 3 || y > 3) pieces[0].push_back({x, y, z});
  for (const Cell2& at : {Cell2{0, 0}, Cell2{2, 0}, Cell2{0, 2}, Cell2{2, 3}}) pieces.push_back({{at[0], at[1], 0}});
  const Assembly assembly = assembly_of(pieces, Pose{}, Vec3::Ones());
  BlockingParameters params;
  params.translation_states = 50;
  params.rotations = params.simultaneous = false;
  const auto stops = [](const PathQuery&, RunContext& context) {
    context.cancel.cancel();
    return fake::outcome(Outcome::cancelled);
  };
  RunContext run_context;
  const RunResult result = run(assembly, fake::setup(stops, std::make_shared<Blocking>(params)), {}, run_context);
  int said = 0;
  for (const PlanUnsolved& u : result.plan.unsolved) {
    EXPECT_EQ(u.message.find("not tried"), std::string::npos) << u.message;
    said += u.message.find("after 50 arrangements, ") != std::string::npos ? 1 : 0;
  }
  EXPECT_EQ(said, 5);
}

TEST(Puzzles, ComeApartIfTheirOutsideIsRound) {
  Rng rng(32);
  for (int trial = 0; trial < 6; ++trial) {
    const Puzzle puzzle = random_puzzle(rng, 3, 3);
    const Assembly assembly = assembly_of(puzzle.pieces, shapes::random_pose(rng, 3), Vec3::Ones(), 0.4);
    RunOptions options;
    options.verify.max_penetration = 0.002;
    const RunResult result = fake::take_apart(assembly, 1, options);
    ASSERT_FALSE(result.plan.disassembly.empty()) << trial;
    // Where material is missing, there are no fewer ways.
    EXPECT_LE(moves_to_first_separation(result.plan), *puzzle.truth.moves) << trial;
  }
}

}  // namespace
}  // namespace dismantle::blocking
