// Long constructions can be aborted at any of their polls.
#include "dismantle/geometry/poll.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "dismantle/geometry/solid.h"
#include "dismantle/testing/shapes.h"

namespace dismantle::geometry {
namespace {

struct GivenUp : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Counts the polls while the mesh is prepared for checks; poll number `last` throws.
std::size_t polls_of(const Mesh& mesh, std::size_t last) {
  std::size_t polls = 0;
  const Poll poll = [&] {
    if (polls++ == last) throw GivenUp("");
  };
  for (Solid& solid : split_into_solids(mesh, poll)) solid.measure_thickness(0.01, poll);
  return polls;
}

TEST(Poll, WhatItThrowsEndsTheConstructionOfALargeSolid) {
  const Mesh large =
      shapes::joined(shapes::sphere({0, 0, 0}, 1, 6), shapes::inside_out(shapes::sphere({0, 0, 0}, 0.5, 6)));
  const std::size_t polls = polls_of(large, ~std::size_t{0});
  EXPECT_GT(polls, 10u);
  for (std::size_t last = 0; last < polls; ++last) EXPECT_THROW(polls_of(large, last), GivenUp) << last;
}

TEST(Poll, SmallOnesAreNotInterrupted) { EXPECT_EQ(polls_of(shapes::sphere({0, 0, 0}, 1, 4), 0), 0u); }

}  // namespace
}  // namespace dismantle::geometry
