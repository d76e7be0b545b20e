#include "dismantle/path/path_thinning.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dismantle::path {
namespace {

/// Upper bound of the distance that any point of the ball moves between the two poses.
double apart(const Pose& a, const Pose& b, const Ball& ball) {
  return (a * ball.center - b * ball.center).norm() + angle_between(a.q, b.q) * ball.radius;
}

}  // namespace

std::vector<Ball> balls_of(const World& world) {
  std::vector<Ball> balls;
  for (std::size_t i = 0; i < world.scene().moving.size(); ++i)
    balls.push_back({world.center(i), world.space() == MotionSpace::translation ? 0.0 : world.radius(i)});
  return balls;
}

Path thin(const Path& path, const std::vector<Ball>& bodies, double tolerance) {
  const std::size_t n = path.size();
  if (n <= 2) return path;
  // Parameter of each instant: length covered so far, by the body that moves most in each step.
  std::vector<double> lengths(n, 0.0);
  for (std::size_t k = 1; k < n; ++k) {
    double step = 0;
    for (std::size_t i = 0; i < bodies.size(); ++i) step = std::max(step, apart(path[k - 1][i], path[k][i], bodies[i]));
    lengths[k] = lengths[k - 1] + step;
  }
  std::vector<bool> keep(n, false);
  keep.front() = keep.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> pending{{0, n - 1}};
  while (!pending.empty()) {
    const auto [a, b] = pending.back();
    pending.pop_back();
    if (b - a < 2) continue;
    const double length = lengths[b] - lengths[a];
    double worst = -1;
    std::size_t at = a;
    for (std::size_t k = a + 1; k < b; ++k) {
      const double u = length > 0 ? (lengths[k] - lengths[a]) / length : 0;
      double deviation = 0;
      for (std::size_t i = 0; i < bodies.size(); ++i)
        deviation = std::max(deviation, apart(screw_interpolate(path[a][i], path[b][i], u), path[k][i], bodies[i]));
      if (deviation > worst) {
        worst = deviation;
        at = k;
      }
    }
    bool turns = false;
    for (std::size_t i = 0; i < bodies.size(); ++i) turns |= angle_between(path[a][i].q, path[b][i].q) > kMostTurn;
    if (worst <= tolerance && !turns) continue;
    if (worst <= tolerance) at = a + (b - a) / 2;
    keep[at] = true;
    pending.emplace_back(a, at);
    pending.emplace_back(at, b);
  }
  Path result;
  for (std::size_t k = 0; k < n; ++k)
    if (keep[k]) result.push_back(path[k]);
  return result;
}

}  // namespace dismantle::path
