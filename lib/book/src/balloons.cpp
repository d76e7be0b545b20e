#include "balloons.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace dismantle {
namespace {

/// Share of a disc that is drawn on, from a coarse grid of samples.
double covered(const Image& image, const Eigen::Vector2d& middle, double radius) {
  int drawn = 0, all = 0;
  for (int i = -2; i <= 2; ++i)
    for (int k = -2; k <= 2; ++k) {
      const int x = static_cast<int>(middle.x() + 0.5 * i * radius),
                y = static_cast<int>(middle.y() + 0.5 * k * radius);
      ++all;
      if ((image.pixels[static_cast<std::size_t>(y) * image.width + x] >> 24) > 40) ++drawn;
    }
  return double(drawn) / all;
}

bool cross(const Balloon& a, const Balloon& b) {
  const auto side = [](const Eigen::Vector2d& p, const Eigen::Vector2d& q, const Eigen::Vector2d& r) {
    return (q.x() - p.x()) * (r.y() - p.y()) - (q.y() - p.y()) * (r.x() - p.x());
  };
  return side(a.at, a.middle, b.at) * side(a.at, a.middle, b.middle) < 0 &&
         side(b.at, b.middle, a.at) * side(b.at, b.middle, a.middle) < 0;
}

double distance_to_line(const Eigen::Vector2d& p, const Balloon& line) {
  const Eigen::Vector2d d = line.middle - line.at;
  const double u = std::clamp((p - line.at).dot(d) / d.squaredNorm(), 0.0, 1.0);
  return (line.at + u * d - p).norm();
}

}  // namespace

double balloon_radius(int width) { return 0.016 * width + 2.5; }

std::vector<Balloon> placed_balloons(std::vector<Balloon> wanted, const Image& image) {
  const double radius = balloon_radius(image.width), room = radius + 2;
  const Eigen::Vector2d centre(0.5 * image.width, 0.5 * image.height);
  // Those at the rim first: the others have to go around them.
  std::ranges::stable_sort(wanted, std::greater{}, [&](const Balloon& b) { return (b.at - centre).norm(); });
  std::vector<Balloon> out;
  for (Balloon& balloon : wanted) {
    constexpr int kAngles = 24, kRings = 8;
    double least = std::numeric_limits<double>::infinity();
    Eigen::Vector2d best = balloon.at;
    for (int ring = 0; ring < kRings; ++ring)
      for (int k = 0; k < kAngles; ++k) {
        const double angle = 2 * std::numbers::pi * k / kAngles, length = radius * (2.2 + 1.6 * ring);
        balloon.middle = balloon.at + length * Eigen::Vector2d(std::cos(angle), std::sin(angle));
        const Eigen::Vector2d& m = balloon.middle;
        if (m.x() < room || m.y() < room || m.x() > image.width - room || m.y() > image.height - room) continue;
        double cost = length / radius + 12 * covered(image, m, radius);
        cost -= 1.5 * (m - balloon.at).normalized().dot((balloon.at - centre).normalized());  // outwards
        bool free = true;
        for (const Balloon& other : out) {
          free = free && (other.middle - m).norm() > 2.15 * radius && distance_to_line(m, other) > 1.15 * radius &&
                 distance_to_line(other.middle, balloon) > 1.15 * radius;
          if (cross(balloon, other)) cost += 20;
        }
        if (free && cost < least) least = cost, best = m;
      }
    if (!std::isfinite(least)) continue;
    balloon.middle = best;
    out.push_back(balloon);
  }
  std::ranges::stable_sort(out, {}, &Balloon::number);
  return out;
}

}  // namespace dismantle
