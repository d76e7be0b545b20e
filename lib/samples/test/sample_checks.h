/// Sampled checks of samples: surfaces, distances and motions, on the triangles as written.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/parameters.h"
#include "dismantle/pose.h"
#include "dismantle/run_context.h"
#include "dismantle/samples/samples.h"

namespace dismantle::samples {

/// A part made ready for queries: its hierarchy and points all over its surface.
struct Probe {
  std::string name;
  const Mesh* mesh = nullptr;
  std::unique_ptr<TriangleBvh> bvh;
  Aabb box;
  std::vector<Eigen::Vector3d> points;
};

namespace detail {

/// Does the open segment p-q pass through the inside of the triangle?
inline bool crosses(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const std::array<Eigen::Vector3d, 3>& t) {
  const Eigen::Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
  const double size = std::max((t[1] - t[0]).norm(), (q - p).norm()), eps = 1e-9 * size;
  const double dp = normal.dot(p - t[0]), dq = normal.dot(q - t[0]);
  if (!((dp > eps && dq < -eps) || (dp < -eps && dq > eps))) return false;
  const Eigen::Vector3d x = p + (q - p) * (dp / (dp - dq));
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d edge = t[(k + 1) % 3] - t[k];
    if (normal.dot(edge.cross(x - t[k])) < eps * edge.norm()) return false;
  }
  return true;
}

inline bool share_corner(const Triangle& a, const Triangle& b) {
  return std::any_of(a.begin(), a.end(), [&b](auto v) { return std::find(b.begin(), b.end(), v) != b.end(); });
}

inline bool reaches(const Probe& a, const Pose& pose_a, const Probe& b, const Pose& pose_b, double distance) {
  const Pose relative = pose_b.inverse() * pose_a;
  Aabb near = b.box;
  near.inflate(distance);
  Aabb there;  // of a's box, seen from b
  for (int corner = 0; corner < 8; ++corner)
    there.extend(relative * Eigen::Vector3d((corner & 1 ? a.box.hi : a.box.lo).x(),
                                            (corner & 2 ? a.box.hi : a.box.lo).y(),
                                            (corner & 4 ? a.box.hi : a.box.lo).z()));
  if (!near.overlaps(there)) return false;
  return std::any_of(a.points.begin(), a.points.end(), [&](const Eigen::Vector3d& p) {
    const Eigen::Vector3d x = relative * p;
    if (!near.contains(x)) return false;
    return b.bvh->closest(x, distance).distance < distance || b.bvh->inside(x);
  });
}

}  // namespace detail

/// Points at random, about `points_per_part` of each part, besides its vertices and the middles of its triangles;
/// of all these, a random choice of at most `most`.
inline std::vector<Probe> probes(const Model& model, Rng& rng, std::size_t points_per_part = 3000,
                                 std::size_t most = 200'000) {
  std::vector<Probe> all;
  for (const RawPart& part : model.parts) {
    Probe probe;
    probe.name = part.name;
    probe.mesh = &part.mesh;
    probe.bvh = std::make_unique<TriangleBvh>(part.mesh);
    probe.box = part.mesh.box();
    probe.points = part.mesh.vertices;
    double area = 0;
    const auto area_of = [&](std::size_t t) {
      const Eigen::Vector3d &a = part.mesh.vertex(t, 0), &b = part.mesh.vertex(t, 1), &c = part.mesh.vertex(t, 2);
      return (b - a).cross(c - a).norm() / 2;
    };
    for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) area += area_of(t);
    for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) {
      const auto& m = part.mesh;
      probe.points.push_back((m.vertex(t, 0) + m.vertex(t, 1) + m.vertex(t, 2)) / 3);
      const auto count = static_cast<std::size_t>(static_cast<double>(points_per_part) * area_of(t) / area);
      for (std::size_t i = 0; i < count; ++i) {
        double u = rng.uniform(), v = rng.uniform();
        if (u + v > 1) u = 1 - u, v = 1 - v;
        probe.points.push_back(m.vertex(t, 0) + u * (m.vertex(t, 1) - m.vertex(t, 0)) +
                               v * (m.vertex(t, 2) - m.vertex(t, 0)));
      }
    }
    for (std::size_t i = 0; i < most && probe.points.size() > most; ++i)
      std::swap(probe.points[i], probe.points[i + rng.below(probe.points.size() - i)]);
    if (probe.points.size() > most) probe.points.resize(most);
    all.push_back(std::move(probe));
  }
  return all;
}

/// True when a point of `a` lies inside `b` or within `distance` of its surface, or the other way round.
inline bool closer_than(const Probe& a, const Pose& pose_a, const Probe& b, const Pose& pose_b, double distance) {
  return detail::reaches(a, pose_a, b, pose_b, distance) || detail::reaches(b, pose_b, a, pose_a, distance);
}

namespace detail {

/// Deepest of the points of `a` in `b`, 0 when none is inside.
inline double deepest_point(const Probe& a, const Pose& pose_a, const Probe& b, const Pose& pose_b) {
  const Pose relative = pose_b.inverse() * pose_a;
  double deepest = 0;
  for (const Eigen::Vector3d& p : a.points) {
    const Eigen::Vector3d x = relative * p;
    if (b.box.contains(x) && b.bvh->inside(x)) deepest = std::max(deepest, b.bvh->closest(x).distance);
  }
  return deepest;
}

}  // namespace detail

/// Largest distance of a sampled surface point of one of the two, inside the other, from the other's surface, mm.
inline double sampled_depth(const Probe& a, const Pose& pose_a, const Probe& b, const Pose& pose_b) {
  return std::max(detail::deepest_point(a, pose_a, b, pose_b), detail::deepest_point(b, pose_b, a, pose_a));
}

/// The contact that the truth states for two parts; null: they keep the clearance.
inline const TruthContact* contact_of(const Model& model, const std::string& a, const std::string& b) {
  for (const TruthContact& c : model.truth.contacts)
    if ((c.a == a && c.b == b) || (c.a == b && c.b == a)) return &c;
  return nullptr;
}

/// First pair of triangles without a common corner that cross each other, as text; empty when there is none.
inline std::string self_crossing(const Mesh& mesh, const TriangleBvh& bvh) {
  std::string found;
  for (std::uint32_t t = 0; t < mesh.triangles.size() && found.empty(); ++t) {
    Aabb box;
    for (const auto& corner : bvh.corners(t)) box.extend(corner);
    bvh.overlapping(box, [&](std::uint32_t other) {
      if (!found.empty() || other == t || detail::share_corner(mesh.triangles[t], mesh.triangles[other])) return;
      for (int k = 0; k < 3; ++k)
        if (detail::crosses(mesh.vertex(t, k), mesh.vertex(t, (k + 1) % 3), bvh.corners(other)))
          found = "triangles " + std::to_string(t) + " and " + std::to_string(other);
    });
  }
  return found;
}

using Poses = std::map<std::string, Pose>;

/// Poses after the share u of a step that starts at `from`.
inline Poses moved(const TruthStep& step, const Poses& from, double u) {
  Poses to = from;
  for (const TruthMotion& motion : step.motions) to[motion.part] = motion.screw.at(u) * to[motion.part];
  return to;
}

/// Random complete parameters of a sample; numbers log-uniform in their range (or around the default).
inline ParamSet random_parameters(const Sample& sample, Rng& rng) {
  ParamSet values;
  for (const ParamSpec& spec : sample.params) {
    if (spec.type == ParamType::boolean) {
      values[spec.name] = rng.below(2) == 1;
    } else if (spec.type == ParamType::choice) {
      values[spec.name] = spec.choices[rng.below(spec.choices.size())].name;
    } else {
      const double fallback = spec.type == ParamType::integer
                                  ? static_cast<double>(std::get<std::int64_t>(spec.fallback))
                                  : std::get<double>(spec.fallback);
      const double reach = std::max(1.0, std::abs(fallback));
      const double lo = std::max(spec.min.value_or(-reach), fallback > 0 ? fallback / 3 : fallback - reach);
      const double hi = std::min(spec.max.value_or(reach), fallback > 0 ? fallback * 3 : fallback + reach);
      const double x = lo > 0 ? lo * std::pow(hi / lo, rng.uniform()) : rng.uniform(lo, hi);
      if (spec.type == ParamType::integer)
        values[spec.name] = static_cast<std::int64_t>(std::clamp(std::round(x), std::ceil(lo), std::floor(hi)));
      else
        values[spec.name] = x;
    }
  }
  return values;
}

/// As make_model, for random parameters: draws again while the maker refuses the combination.
inline Model random_model(const Sample& sample, Rng& rng, ParamSet& drawn) {
  for (int attempt = 0; attempt < 200; ++attempt) {
    drawn = random_parameters(sample, rng);
    try {
      return make_model(sample.name, drawn);
    } catch (const std::invalid_argument&) {
      // A combination that the sample documents as refused: draw again.
    }
  }
  throw std::runtime_error(sample.name + " refuses every combination of parameters");
}

inline std::string text(const ParamSet& values) {
  std::string out;
  for (const auto& [name, value] : values) out += name + "=" + to_text(value) + " ";
  return out;
}

inline std::vector<std::string> sample_names() {
  std::vector<std::string> names;
  for (const Sample& s : list()) names.push_back(s.name);
  return names;
}

}  // namespace dismantle::samples
