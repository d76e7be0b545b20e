#include "path_normalizer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "dismantle/aabb.h"
#include "dismantle/geometry/numerics.h"

namespace dismantle {

namespace {

PartBall ball_of(const Mesh& mesh) {
  PartBall ball;
  if (mesh.vertices.empty()) return ball;
  ball.center = mesh.box().center();
  for (const auto& v : mesh.vertices) ball.radius = std::max(ball.radius, (v - ball.center).norm());
  return ball;
}

/// Checks the shape of the path and makes its quaternions unit and continuous in sign. Returns what is wrong.
std::string clean(Path& path, const std::vector<PlacedPart>& moving, double size) {
  if (path.empty()) return "the path is empty";
  for (std::size_t k = 0; k < path.size(); ++k) {
    if (path[k].size() != moving.size())
      return fmt::format("instant {} has {} poses for {} moving parts", k, path[k].size(), moving.size());
    for (std::size_t i = 0; i < path[k].size(); ++i) {
      Pose& pose = path[k][i];
      if (!pose.t.allFinite() || !pose.q.coeffs().allFinite()) return fmt::format("instant {} is not finite", k);
      if (std::abs(pose.q.norm() - 1) > kPoseError) return fmt::format("instant {} has no unit quaternion", k);
      if (k == 0) {
        if (!same_pose(pose, moving[i].pose, geometry::kRounding, size))
          return "the path does not start where its parts are";
        pose = moving[i].pose;
      } else {
        pose.q.normalize();
        if (pose.q.dot(path[k - 1][i].q) < 0) pose.q.coeffs() = -pose.q.coeffs();
      }
    }
  }
  return {};
}

}  // namespace

PathNormalizer::PathNormalizer(const Assembly& assembly) {
  Aabb box;
  for (const auto& part : assembly.parts) {
    balls_.push_back(ball_of(*part.mesh));
    box.extend(part.mesh->box());
  }
  size_ = box.empty() ? 0.0 : box.size().maxCoeff();
  // docs/plan-format.md allows 1 % of the largest edge between two poses; the margin is for rounding when poses are
  // converted to input units and back.
  max_travel_ = 0.01 * 0.99 * size_;
  // A four-hundredth of the tightest known fit (clearance 4e-5 of the size), so that dropping an instant this close to
  // the screw motion through its neighbours makes no valid path invalid. The simplified path is verified.
  tolerance_ = 1e-7 * size_;
}

bool same_pose(const Pose& a, const Pose& b, double error, double size) {
  const double turn = std::min((a.q.coeffs() - b.q.coeffs()).cwiseAbs().maxCoeff(),
                               (a.q.coeffs() + b.q.coeffs()).cwiseAbs().maxCoeff());
  return turn <= error && (a.t - b.t).cwiseAbs().maxCoeff() <= error * (size + b.t.norm());
}

double PathNormalizer::travel(const std::vector<Pose>& a, const std::vector<Pose>& b,
                              const std::vector<PlacedPart>& moving) const {
  double most = 0;
  for (std::size_t i = 0; i < moving.size(); ++i) {
    const PartBall& ball = balls_[moving[i].part];
    most = std::max(most, screw_travel(a[i], b[i], ball.center, ball.radius));
  }
  return most;
}

std::size_t NormalizedPath::given_instant(std::size_t segment, double u) const {
  const std::size_t a = std::min(segment, lengths.size() - 1);
  const std::size_t b = std::min(segment + 1, lengths.size() - 1);
  const double place = lengths[a] + std::clamp(u, 0.0, 1.0) * (lengths[b] - lengths[a]);
  const auto after = std::upper_bound(given_lengths.begin(), given_lengths.end(), place);
  return after == given_lengths.begin() ? 0 : static_cast<std::size_t>(after - given_lengths.begin()) - 1;
}

std::vector<double> PathNormalizer::lengths_along(const Path& path, const std::vector<PlacedPart>& moving) const {
  std::vector<double> lengths(path.size(), 0.0);
  for (std::size_t k = 1; k < path.size(); ++k) lengths[k] = lengths[k - 1] + travel(path[k - 1], path[k], moving);
  return lengths;
}

Eigen::Vector3d PathNormalizer::displacement(const Path& path, const std::vector<PlacedPart>& moving) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < moving.size(); ++i) {
    const Eigen::Vector3d& center = balls_[moving[i].part].center;
    sum += path.back()[i] * center - path.front()[i] * center;
  }
  return sum / static_cast<double>(moving.size());
}

// Ramer-Douglas-Peucker on screw motions: an instant is dropped if it lies within the tolerance on the screw motion
// between kept instants, at the parameter that follows from the path length.
std::vector<std::size_t> PathNormalizer::essential(const Path& path, const std::vector<double>& lengths,
                                                   const std::vector<PlacedPart>& moving) const {
  const std::size_t n = path.size();
  std::vector<bool> keep(n, false);
  keep.front() = keep.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, n - 1}};
  std::vector<Pose> there(moving.size());
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    double worst = tolerance_;
    std::size_t where = 0;
    const double length = lengths[last] - lengths[first];
    for (std::size_t k = first + 1; k < last; ++k) {
      const double u = length > 0 ? (lengths[k] - lengths[first]) / length : 0.0;
      for (std::size_t i = 0; i < moving.size(); ++i) there[i] = screw_interpolate(path[first][i], path[last][i], u);
      const double off = travel(path[k], there, moving);
      if (off > worst) {
        worst = off;
        where = k;
      }
    }
    if (where == 0) continue;
    keep[where] = true;
    open.emplace_back(first, where);
    open.emplace_back(where, last);
  }
  std::vector<std::size_t> kept;
  for (std::size_t k = 0; k < n; ++k)
    if (keep[k]) kept.push_back(k);
  return kept;
}

NormalizedPath PathNormalizer::normalize(const Path& path, const std::vector<PlacedPart>& moving) const {
  NormalizedPath result;
  Path clean_path = path;
  result.problem = clean(clean_path, moving, size_);
  if (!result.problem.empty()) return result;
  result.given_lengths = lengths_along(clean_path, moving);
  const std::vector<std::size_t> kept = essential(clean_path, result.given_lengths, moving);
  result.path.push_back(clean_path.front());
  result.lengths.push_back(0);
  for (std::size_t j = 1; j < kept.size(); ++j) {
    const std::vector<Pose>& a = clean_path[kept[j - 1]];
    const std::vector<Pose>& b = clean_path[kept[j]];
    const double moved = travel(a, b, moving);
    const double share = max_travel_ > 0 ? std::ceil(moved / max_travel_) : 1.0;
    const double max_instants = 1e5;  // a thousand lengths of the assembly: the planner diverged
    if (!(share + static_cast<double>(result.path.size()) <= max_instants)) {
      result.problem =
          fmt::format("the path is too long: over {} assembly units of travel", max_instants * max_travel_);
      return result;
    }
    const std::size_t pieces = share > 1 ? static_cast<std::size_t>(share) : 1;
    for (std::size_t p = 1; p <= pieces; ++p) {
      const double u = static_cast<double>(p) / static_cast<double>(pieces);
      std::vector<Pose> instant = b;
      if (p < pieces)
        for (std::size_t i = 0; i < moving.size(); ++i) instant[i] = screw_interpolate(a[i], b[i], u);
      result.path.push_back(std::move(instant));
      const double begin = result.given_lengths[kept[j - 1]];
      result.lengths.push_back(begin + u * (result.given_lengths[kept[j]] - begin));
    }
  }
  if (result.path.size() == 1) {  // a plan's move has at least two poses
    result.path.push_back(result.path.front());
    result.lengths.push_back(0);
  }
  return result;
}

}  // namespace dismantle
