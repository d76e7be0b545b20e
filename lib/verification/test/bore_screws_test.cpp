// A screw in a plain bore that is narrower than its thread leaves along the bore, however it stands in it.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "dismantle/samples/samples.h"
#include "dismantle/testing/shapes.h"
#include "dismantle/testing/trials.h"
#include "dismantle/verification/contact.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {
namespace {

using shapes::Vec3;

/// A height of an outline, and the radius there by angle; 0 at the ends of the outline: a point of the axis.
struct Ring {
  double z = 0;
  std::function<double(double)> radius;
};

Ring circle(double z, double r) {
  return {z, [r](double) { return r; }};
}
Ring square(double z, double half) {
  return {z, [half](double a) { return half / std::max(std::abs(std::cos(a)), std::abs(std::sin(a))); }};
}

/// The closed body of an outline that begins and ends on the axis, at heights z0 and z1.
Mesh turned(double z0, const std::vector<Ring>& rings, double z1, std::uint32_t around) {
  Mesh m;
  m.vertices.emplace_back(0, 0, z0);
  for (const Ring& ring : rings)
    for (std::uint32_t i = 0; i < around; ++i) {
      const double a = 2 * std::numbers::pi * i / around, r = ring.radius(a);
      m.vertices.emplace_back(r * std::cos(a), r * std::sin(a), ring.z);
    }
  m.vertices.emplace_back(0, 0, z1);
  const auto count = static_cast<std::uint32_t>(rings.size()), last = count * around + 1;
  for (std::uint32_t i = 0; i < around; ++i) {
    const std::uint32_t j = (i + 1) % around, top = (count - 1) * around + 1;
    m.triangles.push_back({0, 1 + j, 1 + i});
    for (std::uint32_t k = 0; k + 1 < count; ++k) {
      const std::uint32_t a = k * around + 1, b = a + around;
      m.triangles.push_back({a + i, a + j, b + j});
      m.triangles.push_back({a + i, b + j, b + i});
    }
    m.triangles.push_back({top + i, top + j, last});
  }
  return m;
}

/// A screw with its seat at height 0. A modelled thread ends on the seat.
Mesh screw(double d, double pitch, double length, bool threaded, std::uint32_t around) {
  std::vector<Ring> rings;
  const double core = 0.5 * d - 0.62 * pitch;
  if (threaded) {
    const int rows = static_cast<int>(8 * length / pitch);
    rings.push_back(circle(-length, core));
    for (int k = 0; k <= rows; ++k) {
      const double z = -0.95 * length * (1 - static_cast<double>(k) / rows);
      rings.push_back({z, [d, pitch, z](double a) {
                         const double turns = z / pitch - a / (2 * std::numbers::pi);
                         return 0.5 * d - 0.6134 * pitch * std::abs(2 * (turns - std::floor(turns)) - 1);
                       }});
    }
    rings.push_back(circle(0, core));
  } else {
    rings = {circle(-length, 0.5 * d), circle(0, 0.5 * d)};
  }
  rings.push_back(circle(0, 0.8 * d));
  rings.push_back(circle(0.7 * d, 0.8 * d));
  return turned(-length, rings, 0.7 * d, around);
}

/// A block with its face at height 0, and a blind bore.
Mesh block(double d, double bore, double depth, std::uint32_t around) {
  return turned(-depth - d, {square(-depth - d, 2 * d), square(0, 2 * d), circle(0, bore), circle(-depth, bore)},
                -depth, around);
}

/// A screw slides by `by` past a part that it cuts into, in as many instants as a plan file has.
MotionCheck slide(const Mesh& screw, const Mesh& bore, const Vec3& by, double tolerance) {
  constexpr int kInstants = 100;
  Assembly assembly = shapes::assembly_of({screw, bore});
  const DepthBody a(screw), b(bore);
  const Penetration deepest = deepest_penetration(a, Pose{}, b, Pose{}, 1e-4);
  InitialOverlap overlap{0, 1, deepest.depth};
  overlap.place = classify_overlap(a, b, deepest, 1e-4).place;
  assembly.overlaps = {overlap};
  EXPECT_GT(deepest.depth, 0.01);
  Path out;
  for (int k = 0; k <= kInstants; ++k) out.push_back({shapes::shift(by * k / kInstants)});
  return Verifier(assembly, {tolerance}).check_motion({0}, {{1, Pose{}}}, out);
}

TEST(BoreScrews, LeaveAlongTheirBore) {
  Rng rng(1);
  for (int trial = 0; trial < testing_support::trials(4, 60); ++trial) {
    const double tolerance = trial % 4 < 2 ? 0.01 : 0.001;
    const bool off_axis = rng.uniform() < 0.5, tilted = rng.uniform() < 0.5;
    const bool threaded = trial % 2 == 0;
    const double d = rng.uniform(0.8, 3), pitch = d * rng.uniform(0.14, 0.2), length = d * rng.uniform(1, 1.5);
    const double bite = pitch * rng.uniform(0.3, 0.54);
    Pose in_bore;
    const double across = rng.uniform(0, 2 * std::numbers::pi);
    const Vec3 side(std::cos(across), std::sin(across), 0);
    if (off_axis) in_bore.t = 0.01 * d * side;
    if (tilted) {  // and lifted, so that the head does not cut into the face
      const double angle = 0.5 * std::numbers::pi / 180;
      in_bore.q = Eigen::Quaterniond(Eigen::AngleAxisd(angle, side));
      in_bore.t.z() += d * std::sin(angle);
    }
    const Pose world = shapes::random_pose(rng, 3);
    const MotionCheck seen = slide(shapes::moved(screw(d, pitch, length, threaded, 24), world * in_bore),
                                   shapes::moved(block(d, 0.5 * d - bite, 1.3 * length, 24), world),
                                   2.5 * length * (world.q * Vec3::UnitZ()), tolerance);
    EXPECT_TRUE(seen.valid) << "trial " << trial << ", tolerance " << tolerance << (threaded ? ", threaded" : "")
                            << (off_axis ? ", off its axis" : "") << (tilted ? ", tilted" : "") << ", diameter " << d
                            << ", pitch " << pitch << ", bite " << bite;
  }
}

/// The border of the overlap crosses long facets, the edge of the bore is passed by many teeth, and the thread ends on
/// one side of its bore.
TEST(BoreScrews, LeaveThroughAPlate) {
  Rng rng(2);
  const samples::Model model = samples::make_model("plain_bore_screw");
  Aabb box;
  for (const RawPart& part : model.parts) box.extend(part.mesh.box());
  const double scale = 10 / box.size().maxCoeff();
  for (int trial = 0; trial < testing_support::trials(3, 20); ++trial) {
    const Pose world = trial == 0 ? Pose{} : shapes::random_pose(rng, 3);
    std::vector<Mesh> meshes;
    for (const RawPart& part : model.parts) {
      meshes.push_back(part.mesh);
      for (Vec3& v : meshes.back().vertices) v = world * (scale * v);
    }
    ASSERT_EQ(model.parts[0].name, "screw");
    const MotionCheck seen = slide(meshes[0], meshes[1], world.q * Vec3(0, 0, -10), 0.001);
    EXPECT_TRUE(seen.valid) << "trial " << trial;
  }
}

}  // namespace
}  // namespace dismantle
