// A depth that the user allows applies to its pair, whatever was measured, and to no other pair.
#include "dismantle/preparation/declared_overlaps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "dismantle/errors.h"
#include "dismantle/testing/shapes.h"

namespace dismantle {
namespace {

using shapes::box;

Assembly three() {
  return shapes::assembly_of({box({0, 0, 0}, {1, 1, 1}), box({0.9, 0, 0}, {2, 1, 1}), box({5, 0, 0}, {6, 1, 1})},
                             {{0, 1, 0.1}});
}

TEST(DeclaredOverlaps, ReplaceWhatWasMeasured) {
  Rng rng(3);
  for (int trial = 0; trial < 50; ++trial) {
    Assembly assembly = three();
    const auto a = static_cast<PartId>(rng.below(3)), b = static_cast<PartId>((a + 1 + rng.below(2)) % 3);
    const double depth = rng.below(4) == 0 ? 0 : rng.uniform(0, 0.5);
    declare_overlap(assembly, assembly.parts[a].name, assembly.parts[b].name, depth);
    for (PartId x = 0; x < 3; ++x)
      for (PartId y = 0; y < 3; ++y) {
        if (x == y) continue;
        const bool declared = std::minmax(x, y) == std::minmax(a, b);
        EXPECT_EQ(assembly.initial_overlap(x, y), declared                                   ? depth
                                                  : std::minmax(x, y) == std::minmax(0u, 1u) ? 0.1
                                                                                             : 0);
      }
    EXPECT_TRUE(std::is_sorted(assembly.overlaps.begin(), assembly.overlaps.end(),
                               [](const auto& p, const auto& q) { return std::pair(p.a, p.b) < std::pair(q.a, q.b); }));
    EXPECT_EQ(assembly.overlap_of(0, 1)->depth, 0.1);
  }
}

TEST(DeclaredOverlaps, AFlexibleWireMayBeCutThrough) {
  for (const double radius : {0.05, 0.2, 0.5}) {
    const Mesh wire = shapes::tube(0, radius, -50 * radius, 50 * radius, 64, 2);
    Assembly assembly = shapes::assembly_of({box({10, 0, 0}, {11, 1, 1}), wire, box({0, 10, 0}, {1, 11, 1})});
    declare_flexible(assembly, "part1");
    EXPECT_NEAR(assembly.initial_overlap(0, 1), 2 * radius, 0.04 * radius);
    EXPECT_NEAR(assembly.initial_overlap(1, 2), 2 * radius, 0.04 * radius);
    EXPECT_EQ(assembly.initial_overlap(0, 2), 0);
  }
}

TEST(DeclaredOverlaps, WhatIsInsideOrTheSameIsNotAllowedUnlessDeclared) {
  for (const ContactClass contact : {ContactClass::inside, ContactClass::duplicate}) {
    Assembly assembly = three();
    assembly.overlaps.front().place.emplace().contact = contact;
    EXPECT_EQ(assembly.initial_overlap(0, 1), 0);
    declare_overlap(assembly, "part0", "part1", 0.3);
    EXPECT_EQ(assembly.initial_overlap(1, 0), 0.3);
  }
}

TEST(DeclaredOverlaps, UnknownPartsAndOneTwiceAreErrors) {
  Assembly assembly = three();
  EXPECT_THROW(declare_overlap(assembly, "part0", "part9", 0.1), InputError);
  EXPECT_THROW(declare_overlap(assembly, "part0", "part0", 0.1), InputError);
  EXPECT_THROW(declare_flexible(assembly, "nut"), InputError);
}

}  // namespace
}  // namespace dismantle
