// Contacts of parts that lie against each other without play.
#include "dismantle/statics/contacts.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "dismantle/testing/shapes.h"
#include "piles.h"

namespace dismantle::statics {
namespace {

using namespace testing;

// Two feet whose bottoms end where the top of the block begins, on either side. A pose that is off by the last digit
// lets them overlap it by strips as wide as a rounding error; the hull of both strips would be the whole top.
TEST(Contacts, StripsAsWideAsARoundingErrorAreNone) {
  const Mesh block = box({0, 0, 0}, {1, 1, 1});
  const Shape below(block);
  for (const double off : {0.0, 1e-16, 4e-16, 1e-14, -4e-16}) {
    const Shape feet(shapes::boxes({Aabb{{-1, 0, 1}, {0 + off, 1, 2}}, Aabb{{1 - off, 0, 1}, {2, 1, 2}}}));
    for (const double gaps : {1.0, 10.0})
      EXPECT_TRUE(contacts_between({&feet, {}}, {&below, {}}, gaps * kTouching).empty()) << off << " " << gaps;
  }
  const Shape overlapping(shapes::boxes({Aabb{{-1, 0, 1}, {0.1, 1, 2}}, Aabb{{0.9, 0, 1}, {2, 1, 2}}}));
  EXPECT_EQ(contacts_between({&overlapping, {}}, {&below, {}}, kTouching).size(), 1u);
}

}  // namespace
}  // namespace dismantle::statics
