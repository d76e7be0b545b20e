// Parts with open surfaces: boxes without a face, cups, sheets, tubes, soups of triangles. Motions are changed at random;
// no point of a part may pass through a wall of the other in one that passes.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iostream>
#include <numbers>
#include <string>
#include <utility>

#include "brute_force.h"
#include "dismantle/preparation/prepare.h"
#include "dismantle/testing/mesh_damage.h"
#include "dismantle/testing/trials.h"
#include "dismantle/verification/verifier.h"

namespace dismantle::trust::walls {
namespace {

constexpr double kTolerance = 0.01;

/// Two parts, the first of which can leave upward from the second.
struct Case {
  std::string name;
  Mesh mover, other;
  double height = 0;  ///< of the motion
};

/// Without the triangles in the plane z = height.
Mesh without_face(Mesh mesh, double height) {
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](auto v) { return std::abs(mesh.vertices[v].z() - height) < 1e-9; });
  });
  return mesh;
}

/// The mantle of a prism with `corners` corners.
Mesh mantle(double radius, double lo, double hi, int corners) {
  Mesh mesh;
  for (int k = 0; k < corners; ++k) {
    const double a = 2 * std::numbers::pi * k / corners;
    for (const double z : {lo, hi}) mesh.vertices.emplace_back(radius * std::cos(a), radius * std::sin(a), z);
  }
  const auto n = static_cast<std::uint32_t>(2 * corners);
  for (std::uint32_t k = 0; k < n; k += 2) {
    const std::uint32_t a = k, b = k + 1, c = (k + 2) % n, d = (k + 3) % n;
    mesh.triangles.push_back({a, c, d});
    mesh.triangles.push_back({a, d, b});
  }
  return mesh;
}

Mesh sheet(double half, double z) {
  return {{{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}}, {{0, 1, 2}, {0, 2, 3}}};
}

/// Every triangle on its own, some of them divided and some turned: T-junctions, no common edges, no orientation.
Mesh soup(const Mesh& mesh, Rng& rng) {
  Mesh out;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = mesh.vertex(t, 0), b = mesh.vertex(t, 1), c = mesh.vertex(t, 2), m = 0.5 * (a + b);
    for (const auto& part : rng.below(2) == 0 ? std::vector<std::array<Vec3, 3>>{{a, b, c}}
                                              : std::vector<std::array<Vec3, 3>>{{a, m, c}, {m, b, c}}) {
      const auto first = static_cast<std::uint32_t>(out.vertices.size());
      out.vertices.insert(out.vertices.end(), part.begin(), part.end());
      out.triangles.push_back({first, first + 1, first + 2});
      if (rng.below(4) == 0) shapes::flip(out, out.triangles.size() - 1);
    }
  }
  return out;
}

/// Between the parts is a gap of 0.0001 to 0.05: which side of a wall a part is on must be clear.
Case random_case(Rng& rng) {
  const double gap = std::pow(10.0, rng.uniform(-4, -1.3)), in = 2 - gap;
  const Mesh cup = without_face(shapes::box({-2, -2, 0}, {2, 2, 3}), 3);
  const Mesh block = shapes::box({-in, -in, gap}, {in, in, 2.5});
  switch (rng.below(8)) {
    case 0:
      return {"block in a cup", block, cup, 4};
    case 1:
      return {"cup in a cup", without_face(block, 2.5), cup, 4};
    case 2:
      return {"cover over a block", without_face(shapes::box({-2, -2, -3}, {2, 2, 0}), -3),
              shapes::box({-in, -in, -3}, {in, in, -gap}), 4};
    case 3:
      return {"sheet in a cup", sheet(in, gap), cup, 4};
    case 4:
      return {"rod in a tube", shapes::tube(0.5, in, -2, 2, 12), mantle(2 + gap, -2, 2, 12), 5};
    case 5:
      return {"tube on a rod", mantle(in, -2, 2, 9), shapes::box({-1, -1, -2}, {1, 1, 2}), 5};
    case 6:
      return {"sheet on a sheet", sheet(2, gap), sheet(3, 0), 2};
    default:
      return {"block in a soup", block, soup(cup, rng), 4};
  }
}

Assembly assembly_of(const Case& c, const Pose& turned) {
  PrepareOptions options;
  options.max_hole = 0;
  options.subdivide = 0;
  options.normalize = false;
  RunContext context;
  PrepareReport report;
  return prepare_assembly({shapes::raw("mover", shapes::moved(c.mover, turned)),
                           shapes::raw("other", shapes::moved(c.other, turned))},
                          c.name, "", options, context, report);
}

bool segment_meets(const Vec3& from, const Vec3& to, const Mesh& mesh) {
  const Vec3 d = to - from;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = mesh.vertex(t, 0), u = mesh.vertex(t, 1) - a, v = mesh.vertex(t, 2) - a, h = d.cross(v);
    const double det = u.dot(h);
    if (std::abs(det) < 1e-300) continue;
    const double x = (from - a).dot(h) / det;
    if (x < 0 || x > 1) continue;
    const Vec3 q = (from - a).cross(u);
    const double y = d.dot(q) / det, s = v.dot(q) / det;
    if (y >= 0 && x + y <= 1 && s >= 0 && s <= 1) return true;
  }
  return false;
}

/// Places near a moving point, as offsets from it, that it can be seen to have come to without passing a wall.
class Companions {
 public:
  static constexpr int kReach = 4;  // in steps of the lattice

  Companions(const Mesh& walls, double farthest) : walls_(walls), step_(farthest / kReach) {
    for (int x = -kReach; x <= kReach; ++x)
      for (int y = -kReach; y <= kReach; ++y)
        for (int z = -kReach; z <= kReach; ++z)
          if (x * x + y * y + z * z <= kReach * kReach) offsets_.emplace_back(x, y, z);
  }

  /// True if some companion of the point follows it all the way.
  bool follow(const std::vector<Vec3>& displacements) const {
    std::vector<char> there(offsets_.size(), 0);
    for (std::size_t k = 0; k < offsets_.size(); ++k) there[k] = offsets_[k].isZero();
    spread(displacements[0], there);
    for (std::size_t i = 0; i + 1 < displacements.size(); ++i) {
      bool any = false;
      for (std::size_t k = 0; k < offsets_.size(); ++k) {
        if (there[k] && segment_meets(at(displacements[i], k), at(displacements[i + 1], k), walls_)) there[k] = 0;
        any = any || there[k];
      }
      if (!any) return false;
      spread(displacements[i + 1], there);
    }
    return true;
  }

 private:
  Vec3 at(const Vec3& p, std::size_t k) const { return p + step_ * offsets_[k].cast<double>(); }
  void spread(const Vec3& p, std::vector<char>& there) const {
    for (bool more = true; more;) {
      more = false;
      for (std::size_t a = 0; a < offsets_.size(); ++a)
        for (std::size_t b = 0; there[a] && b < offsets_.size(); ++b)
          if (!there[b] && (offsets_[a] - offsets_[b]).squaredNorm() <= 2 &&
              !segment_meets(at(p, a), at(p, b), walls_)) {
            there[b] = 1;
            more = true;
          }
    }
  }

  const Mesh& walls_;
  double step_;
  std::vector<Eigen::Vector3i> offsets_;
};

/// True if no point of `part` passes a wall by more than `farthest`. `path`: poses of the part in the frame of the
/// walls. `any`: some point passes one at all.
bool none_passes(const Mesh& part, const Mesh& walls, const std::vector<Pose>& path, double farthest, bool& any) {
  const Companions companions(walls, farthest);
  for (const Vec3& p : surface_points(part, 2.0)) {
    std::vector<Vec3> trace;
    for (const Pose& pose : path) trace.push_back(pose * p);
    bool crosses = false;
    for (std::size_t i = 0; i + 1 < trace.size() && !crosses; ++i)
      crosses = segment_meets(trace[i], trace[i + 1], walls);
    any = any || crosses;
    if (crosses && !companions.follow(trace)) return false;
  }
  return true;
}

Path path_of(const std::vector<Pose>& poses) {
  Path path;
  for (const Pose& pose : poses) path.push_back({pose});
  return path;
}

/// The whole motion at once, or each segment as a motion of its own.
bool accepted(const Verifier& verifier, const std::vector<Pose>& poses, bool one_by_one) {
  if (!one_by_one) return verifier.check_motion({0}, {{1, Pose{}}}, path_of(poses)).valid;
  for (std::size_t k = 0; k + 1 < poses.size(); ++k)
    if (!verifier.check_motion({0}, {{1, Pose{}}}, path_of({poses[k], poses[k + 1]})).valid) return false;
  return true;
}

/// Poses between those of the path, so dense that points move on straight lines.
std::vector<Pose> dense(const std::vector<Pose>& poses) {
  std::vector<Pose> out{poses.front()};
  for (std::size_t k = 0; k + 1 < poses.size(); ++k) {
    const double angle = poses[k].q.angularDistance(poses[k + 1].q);
    const int parts = 1 + static_cast<int>(angle / 0.01);
    for (int i = 1; i <= parts; ++i)
      out.push_back(screw_interpolate(poses[k], poses[k + 1], static_cast<double>(i) / parts));
  }
  return out;
}

TEST(OpenWalls, BruteForceSeesAPassage) {
  const Mesh cup = without_face(shapes::box({-2, -2, 0}, {2, 2, 3}), 3), block = shapes::box({-1, -1, 1}, {1, 1, 2});
  for (const double z : {-4.0, -1.1, 4.0}) {
    bool any = false;
    EXPECT_EQ(none_passes(block, cup, {Pose{}, shapes::shift({0, 0, z})}, 0.02, any), z > 0) << z;
    EXPECT_EQ(any, z < 0) << z;
  }
}

TEST(OpenWalls, NoMutatedMotionPassesThroughOne) {
  Rng rng(52);
  const int trials = testing_support::trials(2000, 100'000);
  int passed = 0, refused = 0, touched = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const Case c = random_case(rng);
    const Pose turned = shapes::random_pose(rng, 0);
    const Assembly assembly = assembly_of(c, turned);
    ASSERT_EQ(assembly.parts.size(), 2U) << c.name;
    ASSERT_TRUE(assembly.parts[0].open || assembly.parts[1].open) << c.name;
    const Verifier verifier(assembly, {kTolerance});
    const Vec3 up = turned.q * Vec3::UnitZ();
    std::vector<Pose> poses;
    for (int k = 0; k <= 4; ++k) poses.push_back({c.height * k / 4 * up, Eigen::Quaterniond::Identity()});
    if (trial < 24) {
      EXPECT_TRUE(accepted(verifier, poses, trial % 2 == 0)) << c.name;
    }
    const std::size_t k = 1 + rng.below(poses.size() - 1);
    const double by = std::pow(10.0, rng.uniform(-3.5, 0.7));
    if (rng.below(3) == 0)
      poses[k] = poses[k] * Pose{Vec3::Zero(), Eigen::Quaterniond(Eigen::AngleAxisd(
                                                   0.3 * by, shapes::random_vector(rng, -1, 1).normalized()))};
    else if (rng.below(2) == 0)
      poses[k].t += by * shapes::random_vector(rng, -1, 1).normalized();
    else
      poses[k].t -= (c.height * static_cast<double>(k) / 4 + by) * up;  // back, and through the wall below
    const bool one_by_one = rng.below(2) == 0;
    if (!accepted(verifier, poses, one_by_one)) {
      ++refused;
      continue;
    }
    ++passed;
    std::vector<Pose> path = dense(poses), back;
    for (const Pose& pose : path) back.push_back(pose.inverse());
    const Mesh &a = *assembly.parts[0].mesh, &b = *assembly.parts[1].mesh;
    // The lattice of companions is coarse: it finds a way only where there is some room.
    const double farthest = 2 * kTolerance;
    bool any = false;
    EXPECT_TRUE(none_passes(a, b, path, farthest, any)) << c.name << ", trial " << trial << ", pose " << k;
    EXPECT_TRUE(none_passes(b, a, back, farthest, any)) << c.name << ", trial " << trial << ", pose " << k;
    touched += any ? 1 : 0;
  }
  EXPECT_GT(passed, trials / 20);
  EXPECT_GT(refused, trials / 4);
  EXPECT_GT(touched, trials / 500) << "none of those that passed came near a wall";
  std::cout << trials << " motions of open parts mutated: " << passed << " passed, " << touched
            << " of them behind a wall by less than the tolerance; " << refused << " refused\n";
}

}  // namespace
}  // namespace dismantle::trust::walls
