// Proofs about pieces of cubes: they hold exactly where a solver that tries everything says so.
#include "translations/translations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dismantle/testing/voxels.h"
#include "prover_rig.h"

namespace dismantle::immobility {
namespace {

using shapes::Vec3;

constexpr double kTolerance = 0.002;

/// Cells at random, in pieces that need not hang together: most of them hold each other.
std::vector<voxels::Piece> random_pieces(Rng& rng, std::size_t count) {
  for (;;) {
    std::vector<voxels::Piece> pieces(count);
    const double share = rng.uniform(0.3, 0.8);
    for (int x = 0; x < 3; ++x)
      for (int y = 0; y < 3; ++y)
        for (int z = 0; z < 3; ++z)
          if (rng.uniform() < share) pieces[rng.below(count)].push_back({x, y, z});
    if (std::none_of(pieces.begin(), pieces.end(), [](const auto& p) { return p.empty(); })) return pieces;
  }
}

ProverRig rig_of(const std::vector<voxels::Piece>& pieces, const Pose& pose, const Vec3& pitch) {
  std::vector<Mesh> meshes;
  for (const auto& piece : pieces) {
    Mesh mesh = voxels::surface(piece);
    for (Vec3& v : mesh.vertices) v = pose * v.cwiseProduct(pitch);
    meshes.push_back(std::move(mesh));
  }
  return {shapes::assembly_of(meshes), kTolerance};
}

std::vector<PartId> all_but_first(std::size_t count) {
  std::vector<PartId> ids;
  for (PartId id = 1; id < count; ++id) ids.push_back(id);
  return ids;
}

TEST(Translations, AreProvedToFailExactlyWhereTheyDo) {
  Rng rng(1);
  int held = 0, free = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const std::size_t count = 2 + rng.below(3);
    const auto pieces = random_pieces(rng, count);
    const voxels::Solution truth = voxels::solve(pieces, 2'000);
    if (!truth.moves && truth.arrangements >= 2'000) continue;
    const Vec3 pitch(rng.uniform(0.5, 2), rng.uniform(0.5, 2), rng.uniform(0.5, 2));
    const ProverRig rig = rig_of(pieces, shapes::random_pose(rng, 3), pitch);
    const auto found = rig.prove(Translations{}, {0}, all_but_first(count), 0.5);
    // Faces may fit a coarser grid than the one they were made on; the cells of the answer need not be those.
    ASSERT_EQ(found.has_value(), !truth.moves) << trial;
    if (!found) {
      ++free;
      continue;
    }
    ++held;
    EXPECT_EQ(rig.objection(Translations{}, "translations", *found, 0.5), "");
    for (const Part& part : rig.assembly().parts) EXPECT_NE(found->text.find(part.name), std::string::npos);
    EXPECT_FALSE(rig.prove(Translations{}, {0}, all_but_first(count), 1)) << "it does not cover rotations";
  }
  EXPECT_GT(held, 10);
  EXPECT_GT(free, 10);
}

/// Play between the faces, and a proof while it is small for the number of parts.
TEST(Translations, CoverPartsWithPlay) {
  const auto cage = [](double play) {
    // A cube in a closed shell with one empty cell beside it.
    const Mesh shell = shapes::joined(
        shapes::box(Vec3::Constant(0.0), Vec3(4, 3, 3)),
        shapes::inside_out(shapes::box(Vec3(1 - play, 1 - play, 1 - play), Vec3(3 + play, 2 + play, 2 + play))));
    const Mesh cube = shapes::box(Vec3(1 + play, 1 + play, 1 + play), Vec3(2 - play, 2 - play, 2 - play));
    return ProverRig(shapes::assembly_of({shell, cube}), kTolerance);
  };
  for (const double play : {0.0, 0.01, 0.05}) {
    const ProverRig rig = cage(play);
    const auto found = rig.prove(Translations{}, {0}, {1}, 0.5);
    ASSERT_TRUE(found) << play;
    EXPECT_EQ(found->numbers.at("arrangements").size(), 6u) << "two places";
    EXPECT_EQ(rig.objection(Translations{}, "translations", *found, 0.5), "");
  }
  // More play than cells may have, and a finer grid.
  const ProverRig loose = cage(0.3);
  const auto found = loose.prove(Translations{}, {0}, {1}, 0.5);
  ASSERT_TRUE(found);
  EXPECT_EQ(loose.objection(Translations{}, "translations", *found, 0.5), "");
}

/// A block in a shell with an empty layer beside it. The outside of the shell is rough, so that no outer cell is whole.
TEST(Translations, CoverPartsWhoseOutsideCutsCells) {
  voxels::Piece shell, block;
  for (int x = 0; x < 7; ++x)
    for (int y = 0; y < 6; ++y)
      for (int z = 0; z < 6; ++z) {
        const bool outer = x == 0 || x == 6 || y == 0 || y == 5 || z == 0 || z == 5;
        if (outer) shell.push_back({x, y, z});
        if (!outer && x < 5 && (x != 1 || y != 1 || z != 1)) block.push_back({x, y, z});
      }
  for (const double cut : {0.0, 0.3}) {
    Mesh rough = voxels::surface(shell);
    const Vec3 size(7, 6, 6);
    for (Vec3& v : rough.vertices) {
      const bool odd = std::lround(v.sum()) % 2 != 0;
      for (int k = 0; k < 3; ++k)
        if (odd && (v[k] == 0 || v[k] == size[k])) v[k] += v[k] == 0 ? cut : -cut;
    }
    const ProverRig rig(shapes::assembly_of({rough, voxels::surface(block)}), kTolerance);
    const auto found = rig.prove(Translations{}, {0}, {1}, 0.5);
    ASSERT_TRUE(found) << cut;
    EXPECT_EQ(rig.objection(Translations{}, "translations", *found, 0.5), "");
  }
}

TEST(Translations, AreRefusedIfAnArrangementIsMissingOrItIsAnotherPuzzle) {
  Rng rng(2);
  int tried = 0;
  while (tried < 10) {
    const auto pieces = random_pieces(rng, 3);
    const voxels::Solution truth = voxels::solve(pieces, 200);
    if (truth.moves || truth.arrangements < 2 || truth.arrangements >= 200) continue;
    ++tried;
    const Pose pose = shapes::random_pose(rng, 3);
    const ProverRig rig = rig_of(pieces, pose, Vec3::Ones());
    const auto found = rig.prove(Translations{}, {0}, {1, 2}, 0.5);
    ASSERT_TRUE(found);
    const std::size_t size = 6;  // of an arrangement: two parts relative to the first
    for (std::size_t k = 0; k < found->numbers.at("arrangements").size(); k += size) {
      Certificate forged = *found;
      auto& list = forged.numbers.at("arrangements");
      list.erase(list.begin() + static_cast<std::ptrdiff_t>(k), list.begin() + static_cast<std::ptrdiff_t>(k + size));
      EXPECT_NE(rig.objection(Translations{}, "translations", forged, 0.5), "") << "without arrangement " << k / size;
    }
    // Without a cell that is in the way, the certificate of the puzzle lists material that is not there.
    for (std::size_t part = 0; part < 3; ++part) {
      if (pieces[part].size() < 2) continue;
      auto fewer = pieces;
      fewer[part].pop_back();
      EXPECT_NE(rig_of(fewer, pose, Vec3::Ones()).objection(Translations{}, "translations", *found, 0.5), "");
    }
  }
}

}  // namespace
}  // namespace dismantle::immobility
