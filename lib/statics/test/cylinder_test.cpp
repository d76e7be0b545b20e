// Contacts of tessellated cylinders.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <utility>

#include "dismantle/statics/verdict.h"
#include "dismantle/testing/shapes.h"
#include "piles.h"

namespace dismantle::statics {
namespace {

using namespace testing;

/// A solid from z = 0 to 2 whose lower circle has its corners between those of the upper one: its facets lean.
Mesh pin(std::uint32_t corners, double lower, double upper) {
  Mesh m;
  const auto at = [&](double k, double radius, double z) {
    const double angle = 2 * M_PI * k / corners;
    m.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
  };
  for (std::uint32_t k = 0; k < corners; ++k) at(k + 0.37, lower, 0);
  for (std::uint32_t k = 0; k < corners; ++k) at(k, upper, 2);
  m.vertices.push_back({0, 0, 0});
  m.vertices.push_back({0, 0, 2});
  for (std::uint32_t k = 0; k < corners; ++k) {
    const std::uint32_t next = (k + 1) % corners;
    m.triangles.push_back({k, corners + next, corners + k});
    m.triangles.push_back({k, next, corners + next});
    m.triangles.push_back({2 * corners, next, k});
    m.triangles.push_back({2 * corners + 1, corners + k, corners + next});
  }
  return m;
}

Verdict verdict_in(const Mesh& pin, const Mesh& around) {
  Pile pile = pile_of({around, pin}, 1, 0.4);
  pile.down = -Eigen::Vector3d::UnitZ();
  return judge(pile).verdict;
}

// Two facets of a cylinder lean by their sagitta over its height. A pin in a bore is pressed in; it does not stand
// there as a wedge does.
TEST(Contacts, APinInABoreIsPressedIn) {
  for (const std::uint32_t corners : {24u, 32u, 40u})
    for (const double turn : {0.0, 0.05})
      EXPECT_EQ(verdict_in(pin(corners, 1, 1), shapes::tube(1, 3, 0, 2, static_cast<int>(corners), 1, turn)),
                Verdict::pressed_in)
          << corners << " " << turn;
}

// A taper of a degree that becomes narrower downwards stands in its seat.
TEST(Contacts, ATaperStandsInItsSeat) {
  const double slope = 2 * std::tan(M_PI / 180);
  Mesh seat = shapes::tube(1, 3, 0, 2, 32);
  for (Eigen::Vector3d& p : seat.vertices)
    if (const double radius = p.head<2>().norm(); radius < 2) p.head<2>() *= (1 - slope + slope * p.z() / 2) / radius;
  EXPECT_EQ(verdict_in(pin(32, 1 - slope, 1), seat), Verdict::stands);
}

}  // namespace
}  // namespace dismantle::statics
