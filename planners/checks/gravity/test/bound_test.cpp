#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "dismantle/run_context.h"
#include "dismantle/statics/hands_bound.h"
#include "dismantle/testing/shapes.h"
#include "gravity.h"

namespace dismantle::checks {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kBlocks = 5;
using Order = std::array<PartId, kBlocks>;

std::vector<PlacedPart> placed(const Order& order, std::size_t from, std::size_t to) {
  std::vector<PlacedPart> parts;
  for (std::size_t i = from; i < to; ++i) parts.push_back({order[i], Pose{}});
  std::ranges::sort(parts, {}, &PlacedPart::part);
  return parts;
}

/// The steps of an order, each from above.
struct Steps {
  Steps(const Assembly& assembly, const Order& order) {
    for (std::size_t k = 1; k < kBlocks; ++k) {
      present[k] = placed(order, 0, k);
      moving[k] = placed(order, k, k + 1);
      questions.push_back({assembly, moving[k], present[k], -Vector3d::UnitZ(), nullptr, Vector3d::UnitZ()});
    }
  }
  std::array<std::vector<PlacedPart>, kBlocks> present, moving;
  std::vector<StepQuestion> questions;
};

std::size_t hands_of(const StepVerdict& verdict) {
  for (const StepNote& note : verdict.notes)
    if (note.kind == "hold") return nlohmann::json::parse(note.data).at("hands").get<std::size_t>();
  return 1;
}

/// A plate, and blocks on it and beyond its rim.
Assembly random_pile(Rng& rng) {
  std::vector<Mesh> meshes{shapes::box({-2, -2, 0}, {2, 2, 1})};
  while (meshes.size() < kBlocks) {
    const double x = rng.uniform(-3.5, 1.8), y = rng.uniform(-2, 0.3), z = meshes.size() < 3 ? 1 : 2;
    meshes.push_back(shapes::box({x, y, z}, {x + 1.7, y + 1.7, z + 1}));
  }
  return shapes::assembly_of(meshes);
}

// Law: no order that begins with what lies on the table takes fewer hands than the bound, which is the same one for all
// orders.
TEST(HandsBound, NoOrderTakesFewer) {
  Rng rng(31);
  unsigned bounded = 0, tight = 0;
  for (int trial = 0; trial < 30; ++trial) {
    const Assembly assembly = random_pile(rng);
    const Gravity gravity;
    std::size_t fewest = kBlocks, bound = 0;
    Order order{0, 1, 2, 3, 4};
    do {
      const Steps steps(assembly, order);
      std::size_t most = 1;
      for (const StepQuestion& q : steps.questions) most = std::max(most, hands_of(gravity.judge(q, RunContext{})));
      fewest = std::min(fewest, most);
      const StepVerdict whole = gravity.judge_plan(steps.questions, RunContext{});
      const std::size_t stated =
          whole.notes.empty() ? 1 : nlohmann::json::parse(whole.notes[0].data).at("hands_at_least").get<std::size_t>();
      if (bound == 0) bound = stated;
      ASSERT_EQ(stated, bound) << trial;
      ASSERT_EQ(whole.certificate.has_value(), bound > 1) << trial;
    } while (std::next_permutation(order.begin() + 1, order.end()));
    EXPECT_LE(bound, fewest) << trial;
    bounded += bound == 2;
    tight += bound == fewest;
  }
  EXPECT_GT(bounded, 5u);
  EXPECT_LT(bounded, 25u);
  EXPECT_GT(tight, 20u);
}

// Law: the check accepts the proof, and no other one.
TEST(HandsBound, ProofDoesNotSurviveMutation) {
  Rng rng(32);
  unsigned proofs = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const Assembly assembly = random_pile(rng);
    const Steps steps(assembly, {0, 1, 2, 3, 4});
    const statics::BuiltPiles piles(assembly, statics::StatedModel("", 0.4, "").options(assembly));
    const statics::HandsBound bound = statics::least_hands(piles, steps.questions);
    if (bound.hands < 2) continue;
    ++proofs;
    ASSERT_EQ(statics::check_least_hands(piles, steps.questions, bound.numbers), "") << trial;
    const auto refused = [&](const char* what, const auto& change) {
      statics::Numbers numbers = bound.numbers;
      change(numbers[what]);
      EXPECT_NE(statics::check_least_hands(piles, steps.questions, numbers), "") << trial << " " << what;
    };
    refused("loose", [](std::vector<double>& of) { of.resize(1); });
    refused("loose", [](std::vector<double>& of) { of.front() = 0; });  // the plate
    refused("loose", [](std::vector<double>& of) { of.back() = 7; });
    refused("loose", [](std::vector<double>& of) { of.push_back(of.back()); });
    refused("falls", [](std::vector<double>& of) { of.pop_back(); });
    refused("falls", [](std::vector<double>& of) { of.push_back(1); });
    refused("falls", [](std::vector<double>& of) {  // the first body the other way
      for (std::size_t i = 2; i < 8; ++i) of[i] = -of[i];
    });
    // A block that stands is not loose.
    for (PartId part = 1; part < kBlocks; ++part)
      if (std::ranges::find(bound.loose, part) == bound.loose.end())
        refused("loose", [&](std::vector<double>& of) { of.insert(std::ranges::lower_bound(of, part), part); });
  }
  EXPECT_GT(proofs, 8u);
}

}  // namespace
}  // namespace dismantle::checks
