// Selection of the contacts with surfaces that guide a body.
#include "dismantle/push_search/touching_surfaces.h"

#include <gtest/gtest.h>

#include "dismantle/run_context.h"

namespace dismantle::push {
namespace {

TEST(TouchingSurfaces, AreThoseOfFixedParts) {
  Rng rng(4);
  for (int round = 0; round < 50; ++round) {
    std::vector<Contact> contacts;
    std::vector<Eigen::Vector3d> expected;
    for (std::uint64_t k = rng.below(40); k > 0; --k) {
      Contact c;
      c.moving = 0;
      c.other = static_cast<PartId>(rng.below(4));
      c.point = {rng.normal(), rng.normal(), rng.normal()};
      c.normal = Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
      c.on_edge = rng.below(4) == 0;
      contacts.push_back(c);
      if (c.other > 1 && !c.on_edge) expected.push_back(c.point);
    }
    const auto samples = touching_surfaces(contacts, {{0, Pose{}}, {1, Pose{}}});
    ASSERT_EQ(samples.size(), expected.size());
    for (std::size_t k = 0; k < samples.size(); ++k) EXPECT_EQ(samples[k].point, expected[k]);
  }
}

}  // namespace
}  // namespace dismantle::push
