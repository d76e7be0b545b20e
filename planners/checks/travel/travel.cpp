#include "travel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace dismantle::checks {

namespace {

constexpr double kSpacing = 1.0 / 32;      // of samples along the way, in sizes of the assembly
constexpr std::size_t kMostSamples = 200;  // of a step
constexpr std::size_t kMostPoints = 128;   // of a moving part

// Rounding of a plan must not decide about round figures of a design: neither a number of samples nor what is close.
constexpr double kOff = 0.37, kGapShare = 0.9991;

/// Vertices, and points that are spread over the area: large triangles get many.
std::vector<Eigen::Vector3d> points_of(const Mesh& mesh) {
  std::vector<Eigen::Vector3d> points;
  const std::size_t stride = 1 + mesh.vertices.size() / kMostPoints;
  for (std::size_t v = 0; v < mesh.vertices.size(); v += stride) points.push_back(mesh.vertices[v]);
  const auto half_area = [&](std::size_t t) {
    return (mesh.vertex(t, 1) - mesh.vertex(t, 0)).cross(mesh.vertex(t, 2) - mesh.vertex(t, 0)).norm();
  };
  double whole = 0, passed = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) whole += half_area(t);
  std::size_t taken = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    passed += half_area(t);
    for (; (static_cast<double>(taken) + kOff) * whole < passed * kMostPoints; ++taken) {
      double u =
          std::fmod(0.7548776662466927 * static_cast<double>(taken), 1.0);  // an even sequence in the unit square
      double v = std::fmod(0.5698402909980532 * static_cast<double>(taken), 1.0);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      points.emplace_back((1 - u - v) * mesh.vertex(t, 0) + u * mesh.vertex(t, 1) + v * mesh.vertex(t, 2));
    }
  }
  return points;
}

}  // namespace

void TravelParameters::describe(Schema<TravelParameters>& s) {
  s.add("gap", &TravelParameters::gap,
        {.unit = "1",
         .min = 0,
         .max = 1,
         .min_open = true,
         .doc = "Parts that are nearer than this are close, as a share of the largest edge of the assembly."});
}

const TriangleBvh& Travel::Scene::surface(const Part& part) const {
  const std::lock_guard lock(mutex);
  auto& known = surfaces.at(part.id);
  if (!known) known = std::make_unique<const TriangleBvh>(*part.mesh);
  return *known;
}

const std::vector<Eigen::Vector3d>& Travel::Scene::points(const Part& part) const {
  const std::lock_guard lock(mutex);
  auto& known = samples.at(part.id);
  if (known.empty()) known = points_of(*part.mesh);
  return known;
}

/// Points of each surface against the other one.
bool Travel::touches(const Assembly& assembly, const Scene& scene, const PlacedPart& moving,
                     const PlacedPart& other) const {
  const double gap = kGapShare * params_.gap * scene.boxes.size();
  const auto near = [&](const PlacedPart& of, const PlacedPart& to) {
    const TriangleBvh& surface = scene.surface(assembly.parts[to.part]);
    const Pose seen = to.pose.inverse() * of.pose;
    Aabb box = scene.boxes.assembled()[to.part];
    box.inflate(gap);
    const std::vector<Eigen::Vector3d>& points = scene.points(assembly.parts[of.part]);
    return std::any_of(points.begin(), points.end(), [&](const Eigen::Vector3d& point) {
      const Eigen::Vector3d p = seen * point;
      return box.contains(p) && surface.closest(p, gap).distance < gap;
    });
  };
  return near(moving, other) || near(other, moving);
}

StepVerdict Travel::verdict_of(const StepQuestion& question, const Scene& scene, const Close& close) const {
  StepVerdict verdict;
  const double size = scene.boxes.size();
  if (question.path == nullptr || question.moving.empty() || !(size > 0)) return verdict;
  const Trace& path = *question.path;
  // Length of each stretch: of the part's middle that goes farthest.
  std::vector<double> lengths(path.size(), 0);
  double whole = 0;
  for (std::size_t k = 1; k < path.size(); ++k) {
    for (std::size_t i = 0; i < question.moving.size(); ++i) {
      const Eigen::Vector3d middle = scene.boxes.assembled().at(question.moving[i].part).center();
      lengths[k] = std::max(lengths[k], (path[k][i] * middle - path[k - 1][i] * middle).norm());
    }
    whole += lengths[k];
  }
  if (!(whole > 0)) return verdict;
  const double gap = kGapShare * params_.gap * size, spacing = std::max(kSpacing * size, whole / kMostSamples);
  std::vector<Aabb> present;
  for (const PlacedPart& p : question.present) {
    present.push_back(scene.boxes.of(p));
    present.back().inflate(gap);
  }
  double tight = 0;
  std::vector<PlacedPart> moving(question.moving.begin(), question.moving.end());
  for (std::size_t k = 1; k < path.size(); ++k) {
    const auto pieces = static_cast<std::size_t>(std::ceil(lengths[k] / spacing + kOff));
    for (std::size_t s = 0; s < pieces; ++s) {
      const double u = (static_cast<double>(s) + 0.5) / static_cast<double>(pieces);
      for (std::size_t i = 0; i < moving.size(); ++i) moving[i].pose = screw_interpolate(path[k - 1][i], path[k][i], u);
      std::vector<const PlacedPart*> near;
      for (std::size_t p = 0; p < present.size(); ++p)
        if (std::any_of(moving.begin(), moving.end(),
                        [&](const PlacedPart& m) { return scene.boxes.of(m).overlaps(present[p]); }))
          near.push_back(&question.present[p]);
      if (!near.empty() && close(moving, near)) tight += lengths[k] / static_cast<double>(pieces);
    }
  }
  verdict.cost = tight / size;
  if (verdict.cost > 0)
    verdict.reason =
        fmt::format("{:.0f} % of the way leads close past other parts, {:.2f} times the size of the assembly",
                    100 * tight / whole, verdict.cost);
  return verdict;
}

StepVerdict Travel::estimate(const StepQuestion& question, const RunContext& /*context*/) const {
  return verdict_of(question, *scenes_.of(question.assembly), [](const auto&, const auto&) { return true; });
}

StepVerdict Travel::judge(const StepQuestion& question, const RunContext& /*context*/) const {
  const std::shared_ptr<const Scene> scene = scenes_.of(question.assembly);
  return verdict_of(
      question, *scene, [&](const std::vector<PlacedPart>& moving, const std::vector<const PlacedPart*>& near) {
        return std::any_of(near.begin(), near.end(), [&](const PlacedPart* other) {
          return std::any_of(moving.begin(), moving.end(),
                             [&](const PlacedPart& m) { return touches(question.assembly, *scene, m, *other); });
        });
      });
}

}  // namespace dismantle::checks
