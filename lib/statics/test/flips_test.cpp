#include "dismantle/statics/flips.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "dismantle/statics/certificates.h"
#include "dismantle/statics/limits.h"
#include "dismantle/statics/stability.h"
#include "dismantle/testing/shapes.h"
#include "dismantle/testing/trials.h"
#include "piles.h"

namespace dismantle::statics {
namespace {

using namespace testing;
using Json = nlohmann::ordered_json;
using Vec3 = Eigen::Vector3d;

constexpr double kDegree = M_PI / 180;

// A plate on two legs, one of which ends below it by a share of the tolerance of contacts.
Assembly plate_on_legs(double share) {
  const Mesh low = box({0, 0, 0}, {1, 1, 2}), plate = box({0, 0, 2}, {6, 1, 2.5});
  const double gap = share * kTouching * Shape(low).radius();
  return shapes::assembly_of({low, box({5, 0, 0}, {6, 1, 2 - gap}), plate});
}

std::string file_of(const StabilityReport& report, const AssemblyPile& pile, const Assembly& assembly) {
  Json file = Json::parse(report_json(report, assembly, pile));
  file["certificate"] = Json::parse(certificate_json(report, assembly));
  return file.dump();
}

TEST(Flips, BetweenTolerancesOfContacts) {
  for (const double share : {0.4, 0.7, 1.5, 2.5}) {
    SCOPED_TRACE(share);
    const Assembly assembly = plate_on_legs(share);
    const AssemblyPile pile(assembly, {});
    const StabilityReport report = judge_assembly(pile);
    const std::string text = file_of(report, pile, assembly);
    EXPECT_EQ(check_stability_json(text, pile), "");
    if (share < 0.5 || share > 2) {
      EXPECT_EQ(report.judgement.verdict, share < 0.5 ? Verdict::stands : Verdict::falls);
      // It is certified at half and twice the tolerance, too.
      for (const std::size_t missing : {0u, 1u}) {
        Json other = Json::parse(text);
        other["certificate"]["variants"].erase(missing);
        EXPECT_NE(check_stability_json(other.dump(), pile), "");
      }
      continue;
    }
    EXPECT_EQ(report.judgement.verdict, Verdict::uncertain);
    EXPECT_EQ(check_flips(report.variants), "");
    EXPECT_NE(flips_text(report.variants).find("with half the tolerance of contacts it falls"), std::string::npos);
    Json file = Json::parse(text);
    ASSERT_EQ(file["flips"].size(), 3u);
    EXPECT_EQ(file["flips"][0]["verdict"], "falls");
    EXPECT_EQ(file["flips"][2]["verdict"], "stands");
    // What no longer shows a change is refused.
    Json other = file;
    other["certificate"]["variants"].erase(0);
    if (share < 1) {
      EXPECT_NE(check_stability_json(other.dump(), pile), "");
    }
    for (const char* verdict : {"stands", "falls", "pressed_in"}) {
      other = file;
      other["verdict"] = verdict;
      EXPECT_NE(check_stability_json(other.dump(), pile), "");
    }
    other = file;
    other["certificate"]["variants"].clear();
    EXPECT_NE(check_stability_json(other.dump(), pile), "");
    other = file;
    other["certificate"]["variants"][0]["motion"][2]["v"][2] = 1;
    EXPECT_NE(check_stability_json(other.dump(), pile), "");
    other = file;
    other["certificate"]["variants"][0]["touching"] = 0.1;
    EXPECT_NE(check_stability_json(other.dump(), pile), "");
    other = file;
    other["certificate"]["variants"][0]["friction"] = 0.5;
    EXPECT_NE(check_stability_json(other.dump(), pile), "");
  }
}

TEST(Flips, AtTheLimitOfFrictionAndOfToppling) {
  for (const bool topples : {false, true}) {
    const Pile pile = topples ? pile_of({ground(), box({-0.25, -1, 0}, {0.25, 1, 1})}, 1, 0.9)
                              : pile_of({ground(), box({-1, -1, 0}, {1, 1, 0.5})}, 1, 0.3);
    const Pile limit = tilted(pile, Vec3::UnitY(), topples ? std::atan(0.5) : std::atan(0.3));
    const auto flips = flips_of(limit);
    ASSERT_EQ(flips.size(), 2u) << topples;
    EXPECT_EQ(check_flips(flips), "");
    EXPECT_LE(std::abs(flips[0].friction - 1), 1e-4);
    EXPECT_LE(flips[0].tilt, 1e-4);
    // Far from the limit nothing changes.
    EXPECT_TRUE(flips_of(tilted(pile, Vec3::UnitY(), 5 * kDegree)).empty());
  }
}

TEST(Flips, OfVariantsThatAreTooFarApartAreRefused) {
  const Pile pile = tilted(pile_of({ground(), box({-1, -1, 0}, {1, 1, 0.5})}, 1, 0.3), Vec3::UnitY(), std::atan(0.3));
  const auto variant = [&](double friction) {
    Variant v{1, friction, Vec3::Zero(), 0, {}, {}};
    v.pile = varied(pile, v);
    v.judgement = judge(v.pile);
    return v;
  };
  EXPECT_EQ(check_flips({variant(0.995), variant(1.005)}), "");
  EXPECT_NE(check_flips({variant(0.9), variant(1.1)}), "");
  EXPECT_NE(check_flips({variant(1.004), variant(1.005)}), "");
}

// Random piles of a grid near their critical tilt: what is uncertain there flips.
TEST(Flips, EachUncertainVerdictIsShownToFlip) {
  std::mt19937 random(23);
  const int trials = testing_support::trials(15, 1000);
  for (int trial = 0; trial < trials; ++trial) {
    SCOPED_TRACE(trial);
    const Pile pile = pile_of(random_boxes(random, 2 + static_cast<int>(random() % 6)), 1, 0.4);
    const auto limit = critical_tilt(pile, Vec3::UnitY());
    if (!limit) continue;
    const Pile near = tilted(pile, Vec3::UnitY(), *limit * (1 + 1e-7 * (static_cast<double>(random() % 200) - 100)));
    if (judge(near).verdict == Verdict::uncertain) {
      EXPECT_EQ(check_flips(flips_of(near)), "");
    }
  }
}

}  // namespace
}  // namespace dismantle::statics
