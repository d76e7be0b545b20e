#include "dismantle/lattice/arrangements.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "dismantle/testing/voxels.h"

namespace dismantle::lattice {
namespace {

using End = SearchResult::End;

/// Replays the slides cell by cell: no step makes two parts share a cell, and the last slide leaves.
void expect_valid(const std::vector<voxels::Piece>& pieces, const SearchResult& result) {
  std::vector<voxels::Piece> at = pieces;
  for (std::size_t s = 0; s < result.slides.size(); ++s) {
    const Slide& slide = result.slides[s];
    const bool last = s + 1 == result.slides.size();
    EXPECT_EQ(slide.leaves != 0, last);
    const int steps = last ? 50 : std::abs(slide.steps), sign = last ? slide.leaves : slide.steps < 0 ? -1 : 1;
    for (int k = 0; k < steps; ++k) {
      std::set<Cell> taken;
      for (std::size_t i = 0; i < at.size(); ++i)
        for (Cell& c : at[i]) {
          if (slide.parts >> i & 1) c = voxels::moved(c, slide.axis, sign);
          EXPECT_TRUE(taken.insert(c).second);
        }
    }
  }
}

TEST(Arrangements, AreThoseOfASolverThatTriesEverything) {
  Rng rng(21);
  int held = 0, several = 0;
  for (int trial = 0; trial < 400; ++trial) {
    // Cells at random, also where no piece would hang together: most of these pieces hold each other.
    const std::size_t count = 2 + rng.below(3);
    std::vector<voxels::Piece> pieces(count);
    const double share = rng.uniform(0.2, 0.7);
    for (int x = 0; x < 4; ++x)
      for (int y = 0; y < 3; ++y)
        for (int z = 0; z < 3; ++z)
          if (rng.uniform() < share) pieces[rng.below(count)].push_back({x, y, z});
    if (std::any_of(pieces.begin(), pieces.end(), [](const auto& p) { return p.empty(); })) continue;
    const voxels::Solution truth = voxels::solve(pieces);
    if (truth.arrangements >= 20'000) continue;
    const SearchResult result = search_arrangements(pieces, {}, true);
    ASSERT_EQ(result.end, truth.moves ? End::found : End::exhausted) << trial;
    if (truth.moves) {
      EXPECT_EQ(static_cast<int>(result.slides.size()), *truth.moves) << trial;
      expect_valid(pieces, result);
      several += *truth.moves > 1 ? 1 : 0;
    } else {
      EXPECT_EQ(result.visited, truth.arrangements) << trial;
      EXPECT_EQ(result.arrangements.size(), truth.arrangements);
      EXPECT_EQ(result.waiting, 0u);
      ++held;
    }
  }
  EXPECT_GT(held, 20);
  EXPECT_GT(several, 20);
}

TEST(Arrangements, AreTheSameIfAskedAboutCellsThatAreNotFull) {
  Rng rng(22);
  std::size_t questions = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const auto pieces = voxels::random_pieces(rng, {3, 3, 3}, 2 + rng.below(3));
    std::vector<PieceCells> some(pieces.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      some[i].touched = pieces[i];
      for (const Cell& c : pieces[i])
        if (rng.below(2) == 0) some[i].full.push_back(c);
    }
    const auto together = [&](std::size_t i, std::size_t j, const Cell& shift) {
      return std::any_of(pieces[i].begin(), pieces[i].end(), [&](Cell c) {
        for (std::size_t k = 0; k < 3; ++k) c[k] += shift[k];
        return std::find(pieces[j].begin(), pieces[j].end(), c) != pieces[j].end();
      });
    };
    std::set<std::tuple<std::size_t, std::size_t, Cell, int>> asked;
    const StepTest passes = [&](std::size_t i, std::size_t j, const Cell& shift, int axis) {
      EXPECT_TRUE(asked.insert({i, j, shift, axis}).second) << "asked twice";
      return !together(i, j, shift) && !together(i, j, voxels::moved(shift, axis, 1));
    };
    const SearchResult all = search_arrangements(pieces, {}, true), same = search_arrangements(some, passes, {}, true);
    EXPECT_EQ(same.end, all.end);
    EXPECT_EQ(same.slides.size(), all.slides.size());
    EXPECT_EQ(same.arrangements, all.arrangements);
    questions += asked.size();
  }
  EXPECT_GT(questions, 100u);
}

TEST(Arrangements, LimitsSayWhatWaits) {
  // Four cubes in a closed frame with one empty cell: they only change places within it.
  std::vector<voxels::Piece> pieces(1);
  for (int x = -1; x < 6; ++x)
    for (int y = -1; y < 3; ++y)
      for (int z = -1; z < 2; ++z)
        if (x < 0 || y < 0 || z != 0 || x > 4 || y > 1) pieces[0].push_back({x, y, z});
  for (int x = 0; x < 5; x += 2) pieces.push_back({{x, 0, 0}});
  const SearchResult all = search_arrangements(pieces, {}, true);
  ASSERT_EQ(all.end, End::exhausted);
  EXPECT_EQ(all.visited, 10u * 9 * 8) << "three cubes in ten cells";
  EXPECT_EQ(voxels::solve(pieces).arrangements, all.visited);
  const SearchResult some = search_arrangements(pieces, {100, 1e9, {}});
  EXPECT_EQ(some.end, End::limit);
  EXPECT_EQ(some.visited, 100u);
  EXPECT_GT(some.waiting, 0u);
  EXPECT_LE(some.visited + some.waiting, all.visited);
  const SearchResult stopped = search_arrangements(pieces, {100'000, 1e9, [] { return true; }});
  EXPECT_EQ(stopped.end, End::stopped);
}

TEST(Arrangements, PartsThatShareACellAreNotForIt) {
  EXPECT_EQ(search_arrangements({{{0, 0, 0}}, {{0, 0, 0}, {1, 0, 0}}}, {}).end, End::unsuited);
  EXPECT_EQ(search_arrangements({{{0, 0, 0}}}, {}).end, End::unsuited);
  EXPECT_EQ(search_arrangements({{{0, 0, 0}}, {}}, {}).end, End::unsuited);
}

}  // namespace
}  // namespace dismantle::lattice
