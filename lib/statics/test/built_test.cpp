// Piles of placed parts.
#include "dismantle/statics/built.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "dismantle/run_context.h"
#include "dismantle/testing/shapes.h"

namespace dismantle::statics {
namespace {

using Eigen::Vector3d;

Pose random_pose(Rng& rng, double far) {
  const Vector3d axis(rng.normal(), rng.normal(), rng.normal());
  return {far * Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)),
          Eigen::Quaterniond(Eigen::AngleAxisd(rng.uniform(0, 2 * M_PI), axis.normalized()))};
}

/// The pose as it is after it was written in other units and read again.
Pose rounded(const Pose& p, Rng& rng) {
  const auto off = [&](double x) { return x * (1 + rng.uniform(-1, 1) * 4e-16); };
  Eigen::Quaterniond q(off(p.q.w()), off(p.q.x()), off(p.q.y()), off(p.q.z()));
  if (rng.uniform(0, 1) < 0.5) q.coeffs() *= -1;  // the same rotation
  return {p.t.unaryExpr(off), q};
}

void expect_same(const BuiltPile& a, const BuiltPile& b, double size) {
  ASSERT_EQ(a.pile.contacts.size(), b.pile.contacts.size());
  for (std::size_t k = 0; k < a.pile.contacts.size(); ++k) {
    const Contact &x = a.pile.contacts[k], &y = b.pile.contacts[k];
    EXPECT_LT((x.normal - y.normal).norm(), 1e-9);
    ASSERT_EQ(x.points.size(), y.points.size()) << "contact " << k;
    for (std::size_t i = 0; i < x.points.size(); ++i) EXPECT_LT((x.points[i] - y.points[i]).norm(), 1e-9 * size);
  }
}

// Law: contacts do not depend on the last digits of the poses. Symmetric parts have many points that are equally far
// apart, so that rounding decides which ones are taken where nothing else does. Proofs refer to contacts.
TEST(BuiltPiles, TheLastDigitsOfAPoseChangeNoContact) {
  Rng rng(5);
  std::size_t contacts = 0;
  for (int k = 0; k < 40; ++k) {
    const double size = std::pow(10, rng.uniform(-2, 2));
    const int around = 12 + 4 * static_cast<int>(rng.uniform(0, 6));
    std::vector<Mesh> meshes{shapes::tube(1.001, 2, 0, 3, around), shapes::tube(0.4, 1, 0, 3, around),
                             shapes::box({-1, -1, 3}, {1, 1, 4})};
    for (Mesh& m : meshes)
      for (Vector3d& v : m.vertices) v *= size;
    const Assembly assembly = shapes::assembly_of(meshes);
    StabilityOptions options;
    options.touching = 0.004;
    const BuiltPiles piles(assembly, options);
    const Pose all = k % 4 == 0 ? Pose{} : random_pose(rng, 10 * size);
    const Pose turned{{0, 0, 0}, Eigen::Quaterniond(Eigen::AngleAxisd(rng.uniform(0, 6), Vector3d::UnitZ()))};
    const std::vector<PlacedPart> parts{{0, all}, {1, all * turned}, {2, all * turned}};
    std::vector<PlacedPart> read = parts;
    for (PlacedPart& p : read) p.pose = rounded(p.pose, rng);
    const Vector3d up = all.q * Vector3d::UnitZ();
    for (const Gaps gaps : {Gaps::tight, Gaps::play}) {
      const BuiltPile pile = piles.pile(parts, up, gaps);
      contacts += pile.pile.contacts.size();
      expect_same(pile, piles.pile(read, up, gaps), 30 * size);
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(contacts, 1000u);
}

}  // namespace
}  // namespace dismantle::statics
