// Circles with numbers: readable, apart, and not across each other.
#include "balloons.h"

#include <gtest/gtest.h>

#include <random>

namespace dismantle {
namespace {

TEST(Balloons, AreInThePictureApartAndOffTheLinesOfOthers) {
  std::mt19937 random(3);
  std::size_t all = 0;
  for (int trial = 0; trial < 30; ++trial) {
    const int width = 400 + 100 * (trial % 4), height = 300;
    Image image{width, height, std::vector<std::uint32_t>(static_cast<std::size_t>(width) * height, 0)};
    for (int y = height / 4; y < 3 * height / 4; ++y)
      for (int x = width / 4; x < 3 * width / 4; ++x)
        image.pixels[static_cast<std::size_t>(y) * width + x] = 0xff808080u;
    std::uniform_real_distribution<double> x(0.25 * width, 0.75 * width), y(0.25 * height, 0.75 * height);
    std::vector<Balloon> wanted;
    for (std::size_t n = 1; n <= 1 + static_cast<std::size_t>(trial) % 12; ++n)
      wanted.push_back({n, {x(random), y(random)}});
    const std::vector<Balloon> placed = placed_balloons(wanted, image);
    all += placed.size();
    const double radius = balloon_radius(width);
    for (std::size_t i = 0; i < placed.size(); ++i) {
      const Balloon& b = placed[i];
      EXPECT_EQ(b.at, wanted[b.number - 1].at);
      EXPECT_GT(std::min(b.middle.x(), width - b.middle.x()), radius);
      EXPECT_GT(std::min(b.middle.y(), height - b.middle.y()), radius);
      for (std::size_t k = 0; k < i; ++k) {
        EXPECT_LT(placed[k].number, b.number);
        EXPECT_GT((placed[k].middle - b.middle).norm(), 2 * radius);
      }
    }
  }
  EXPECT_GE(all, 170u) << "of 195 that are wanted, some of them at one place";
}

TEST(Balloons, OneAloneIsBesideTheDrawing) {
  Image image{300, 300, std::vector<std::uint32_t>(90000, 0)};
  for (int y = 120; y < 180; ++y)
    for (int x = 120; x < 180; ++x) image.pixels[static_cast<std::size_t>(y) * 300 + x] = 0xff808080u;
  const std::vector<Balloon> placed = placed_balloons({{7, {150, 150}}}, image);
  ASSERT_EQ(placed.size(), 1u);
  EXPECT_GT((placed[0].middle - Eigen::Vector2d(150, 150)).cwiseAbs().maxCoeff(), 30);
}

}  // namespace
}  // namespace dismantle
