// The z-buffer: silhouettes have the computed area, the nearer part is visible, marked bodies show through others.
#include "raster.h"

#include <gtest/gtest.h>

#include <random>

#include "dismantle/testing/shapes.h"

namespace dismantle {
namespace {

std::size_t covered(const Image& image) {
  return static_cast<std::size_t>(std::ranges::count_if(image.pixels, [](std::uint32_t p) { return p >> 24 == 255; }));
}

TEST(Raster, ABoxCoversTheAreaOfItsSilhouette) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> edge(0.5, 3), turn(-1, 1);
  for (int trial = 0; trial < 40; ++trial) {
    const Eigen::Vector3d size(edge(random), edge(random), edge(random));
    const ShadedMesh mesh = shade(shapes::box(-size / 2, size / 2), 0.5);
    Eigen::Quaterniond q(turn(random), turn(random), turn(random), turn(random));
    q.normalize();
    Camera camera;
    camera.scale = 50;
    const std::size_t pixels = covered(draw({{&mesh, {{0, 0, 0}, q}, {1, 0, 0}}}, camera, 300, 300));
    const Eigen::Vector3d toward = (q.conjugate() * Eigen::Vector3d::UnitZ()).cwiseAbs();
    const double area =
        toward.x() * size.y() * size.z() + toward.y() * size.z() * size.x() + toward.z() * size.x() * size.y();
    const double rim = 4 * (size.x() + size.y() + size.z()) * camera.scale;  // pixels that the outline may cross
    EXPECT_NEAR(double(pixels), area * camera.scale * camera.scale, rim) << "trial " << trial;
  }
}

TEST(Raster, TheNearerPartIsSeenWhateverTheOrder) {
  const ShadedMesh mesh = shade(shapes::box({-1, -1, -1}, {1, 1, 1}), 0.5);
  const auto at = [&](double z, const Eigen::Vector3f& colour, bool marked) {
    return DrawnBody{&mesh, {{0, 0, z}, Eigen::Quaterniond::Identity()}, colour, marked};
  };
  Camera camera;
  camera.scale = 20;
  const auto middle = [](const Image& image) { return image.pixels[50 * 100 + 50]; };
  const auto red = [](std::uint32_t p) { return p >> 16 & 255; };
  const auto blue = [](std::uint32_t p) { return p & 255; };
  const DrawnBody near = at(5, {1, 0, 0}, false), far = at(0, {0, 0, 1}, false), marked = at(0, {0, 0, 1}, true);
  for (const auto& bodies : {std::vector{near, far}, std::vector{far, near}}) {
    const std::uint32_t p = middle(draw(bodies, camera, 100, 100));
    EXPECT_GT(red(p), 150u);
    EXPECT_EQ(blue(p), 0u);
  }
  EXPECT_GT(blue(middle(draw({near, marked}, camera, 100, 100))), 30u) << "what is marked shimmers through";
  EXPECT_EQ(visible_pixels({near, marked}, camera, 100, 100), 0u);
  EXPECT_EQ(visible_pixels({marked, at(-5, {1, 0, 0}, false)}, camera, 100, 100), 1600u);
}

TEST(Raster, NothingIsDrawnWhereNothingIs) {
  for (const std::uint32_t p : draw({}, Camera{}, 20, 10).pixels) EXPECT_EQ(p, 0u);
}

}  // namespace
}  // namespace dismantle
