#include "figures.h"

#include <gtest/gtest.h>

#include <string>

namespace dismantle::checks {
namespace {

using Secured = Inserted::Secured;

// Codes and times of worked examples that are published with the tables.
TEST(Figures, AreThoseOfTheTables) {
  EXPECT_EQ(handling({.size = 100, .thickness = 20, .alpha = 0, .beta = 0}).code, "00");
  EXPECT_EQ(handling({.size = 100, .thickness = 20, .alpha = 0, .beta = 0}).seconds, 1.13);
  EXPECT_EQ(handling({.size = 100, .thickness = 20, .alpha = 360, .beta = 360}).code, "30");
  EXPECT_EQ(handling({.size = 100, .thickness = 20, .alpha = 360, .beta = 360}).seconds, 1.95);
  EXPECT_EQ(handling({.size = 12, .thickness = 4, .alpha = 360, .beta = 0}).code, "11");
  EXPECT_EQ(handling({.size = 12, .thickness = 4, .alpha = 360, .beta = 0}).seconds, 1.8);
  EXPECT_EQ(handling({.size = 20, .thickness = 1, .alpha = 360, .beta = 180}).code, "23");
  EXPECT_EQ(handling({.size = 20, .thickness = 1, .alpha = 360, .beta = 180}).seconds, 2.36);
  EXPECT_EQ(insertion({}).seconds, 1.5);
  EXPECT_EQ(insertion({.held = true}).code, "06");
  EXPECT_EQ(insertion({.held = true}).seconds, 5.5);
  EXPECT_EQ(insertion({.hard_to_align = true, .resisting = true, .obstructed = true}).code, "13");
  EXPECT_EQ(insertion({.hard_to_align = true, .resisting = true, .obstructed = true}).seconds, 6);
  EXPECT_EQ(insertion({.resisting = true, .obstructed = true, .held = true}).code, "17");
  EXPECT_EQ(insertion({.resisting = true, .obstructed = true, .held = true}).seconds, 9);
  EXPECT_EQ(insertion({.secured = Secured::at_once, .resisting = true}).code, "31");
  EXPECT_EQ(insertion({.secured = Secured::at_once, .resisting = true}).seconds, 5);
  EXPECT_EQ(insertion({.secured = Secured::screwed, .resisting = true}).code, "39");
  EXPECT_EQ(insertion({.secured = Secured::screwed, .resisting = true}).seconds, 8);
  EXPECT_EQ(insertion({.secured = Secured::screwed, .obstructed = true}).code, "48");
  EXPECT_EQ(insertion({.secured = Secured::screwed, .obstructed = true}).seconds, 8.5);
}

// Law: rounding of lengths that are limits of the tables changes nothing.
TEST(Figures, RoundingDecidesNothing) {
  for (const double size : {6.0, 15.0, 381.0})
    for (const double thickness : {2.0, 5.0}) {
      const std::string code = handling({.size = size, .thickness = thickness}).code;
      for (const double factor : {1 - 1e-6, 1 + 1e-6})
        EXPECT_EQ(handling({.size = size * factor, .thickness = thickness * factor}).code, code) << size;
    }
  EXPECT_EQ(handling({.size = 20, .thickness = 2}).code, "33");
  EXPECT_EQ(handling({.size = 20, .thickness = 2.1}).code, "30");
}

// Law: what is harder never takes less time.
TEST(Figures, HarderIsNotFaster) {
  for (const double size : {3.0, 10.0, 30.0, 500.0})
    for (const double thickness : {1.0, 3.0})
      for (const double alpha : {0.0, 180.0, 360.0})
        for (const double beta : {0.0, 90.0, 180.0, 360.0}) {
          const Handled easy{.size = size, .thickness = thickness, .alpha = alpha, .beta = beta};
          const double seconds = handling(easy).seconds;
          Handled hard = easy;
          hard.beta = 360;
          EXPECT_GE(handling(hard).seconds, seconds);
          hard = easy;
          hard.alpha = 360;
          EXPECT_GE(handling(hard).seconds, seconds);
          hard = easy;
          hard.tangles = true;
          EXPECT_GE(handling(hard).seconds, seconds);
          hard = easy;
          hard.heavy = true;
          EXPECT_GE(handling(hard).seconds, seconds);
        }
  for (const Secured secured : {Secured::no, Secured::at_once, Secured::screwed})
    for (unsigned bits = 0; bits < 16; ++bits)
      for (unsigned more = 0; more < 4; ++more) {
        const auto how = [&](unsigned b) {
          return Inserted{secured, (b & 1) != 0, (b & 2) != 0, (b & 4) != 0, (b & 8) != 0};
        };
        EXPECT_GE(insertion(how(bits | 1u << more)).seconds, insertion(how(bits)).seconds);
      }
}

}  // namespace
}  // namespace dismantle::checks
