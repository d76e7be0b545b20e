// Orders: read, flattened, compared, replayed.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "dismantle/errors.h"
#include "dismantle/orders/agreement.h"
#include "dismantle/orders/order.h"
#include "dismantle/orders/replay.h"
#include "dismantle/testing/fake_planning.h"

namespace dismantle {
namespace {

std::vector<std::vector<std::string>> parts_of(const Order& order) {
  std::vector<std::vector<std::string>> out;
  for (const OrderStep& step : order) out.push_back(step.parts);
  return out;
}

/// Against the textbook formula with all pairs listed; without ties it is the ordinary tau.
TEST(Tau, IsKendallsTauB) {
  EXPECT_EQ(kendall_tau_b(std::vector<double>{1, 2, 3}, std::vector<double>{1, 2, 3}), 1);
  EXPECT_EQ(kendall_tau_b(std::vector<double>{1, 2, 3}, std::vector<double>{3, 2, 1}), -1);
  EXPECT_EQ(kendall_tau_b(std::vector<double>{1, 1, 1}, std::vector<double>{3, 2, 1}), std::nullopt);
  // 5 concordant, 1 discordant... of Agresti, Analysis of Ordinal Categorical Data: C = 2, D = 1, one tie in each.
  const std::vector<double> a{1, 2, 2, 3}, b{1, 3, 2, 2};
  // pairs: (1,2) + (1,3) + (1,4) + ; (2,3) tie in a; (2,4) -; (3,4) tie in b.
  EXPECT_NEAR(*kendall_tau_b(a, b), 2 / std::sqrt(5.0 * 5.0), 1e-12);
  std::mt19937 random(3);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<double> x(12), y(12);
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = static_cast<double>(random() % 5);
      y[i] = static_cast<double>(random() % 5);
    }
    const auto tau = kendall_tau_b(x, y);
    ASSERT_TRUE(tau);
    EXPECT_LE(std::abs(*tau), 1 + 1e-12);
    EXPECT_NEAR(*tau, *kendall_tau_b(y, x), 1e-12) << "symmetric";
    for (double& v : y) v = -v;
    EXPECT_NEAR(*tau, -*kendall_tau_b(x, y), 1e-12) << "the reverse order disagrees as much";
  }
}

TEST(Agreement, EqualPartsStandForEachOther) {
  const Order a{{{"base"}}, {{"screw#1"}}, {{"lid"}}, {{"screw#2"}}};
  const Order b{{{"base"}}, {{"screw#2"}}, {{"lid"}}, {{"screw#1"}}};
  EXPECT_LT(*agreement_of(a, b, {}).tau, 1);
  const Agreement same = agreement_of(a, b, {{"screw#1", "screw"}, {"screw#2", "screw"}});
  EXPECT_EQ(same.tau, 1);
  EXPECT_EQ(same.common, 4u);
  const Agreement some = agreement_of(a, {{{"lid"}}, {{"base"}}, {{"new"}}}, {});
  EXPECT_EQ(some.common, 2u);
  EXPECT_EQ(some.tau, -1);
}

TEST(Order, SubModelsStandWhereTheyArePutIn) {
  const std::vector<PlanReferenceStep> reference{
      {1, {"base"}, "", {0, 0, 1}},
      {1, {"wheel"}, "cart", {0, 0, 1}},
      {2, {"pin", "axle"}, "cart", {0, 0, 1}},
      {2, {"axle", "pin", "top", "wheel"}, "", {0, 0, 1}},
      {3, {"flag"}, "", {0, 0, 1}},
  };
  EXPECT_EQ(parts_of(order_of(reference)),
            (std::vector<std::vector<std::string>>{{"base"}, {"top"}, {"wheel"}, {"axle", "pin"}, {"flag"}}));
}

TEST(Order, APlanIsReadBackwards) {
  Plan plan;
  for (const char* name : {"base", "a", "b", "c"}) plan.assembly.parts.push_back({0, name, ""});
  const auto step = [](const std::vector<std::string>& out, const Eigen::Vector3d& by) {
    PlanStep s;
    s.separates = {out};
    for (const auto& name : out) s.moves.push_back({name, {Pose{}, Pose{by, Pose{}.q}}});
    return s;
  };
  plan.disassembly = {step({"a", "b"}, {0, 0, 5}), step({"c"}, {5, 0, 0}), step({"b"}, {0, 7, 0})};
  const Order order = order_of(plan);
  EXPECT_EQ(parts_of(order), (std::vector<std::vector<std::string>>{{"base"}, {"c"}, {"a"}, {"b"}}));
  EXPECT_FALSE(order[0].direction);
  EXPECT_LT((*order[1].direction + Eigen::Vector3d::UnitX()).norm(), 1e-12) << "it goes in the other way";
  EXPECT_EQ(order[3].travel, 7);
  const OrderMeasures measures = measures_of(order, {{"c", "k"}, {"b", "k"}});
  EXPECT_EQ(measures.steps, 4u);
  EXPECT_EQ(measures.direction_changes, 2u);
  EXPECT_EQ(measures.off_axis, 0u);
  EXPECT_EQ(measures.torn, 1u);
}

TEST(Order, CsvFilesAreReadAndErrorsHaveAPlace) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("dismantle-order-" + std::to_string(::getpid()) + ".csv");
  const auto read = [&](const std::string& text) {
    std::ofstream(file) << text;
    return read_order(file);
  };
  const Order order = read("step,part,direction\r\n2,\"lid, large\",-z\r\n1,base,\r\n2,pin,0 3 4\r\n");
  EXPECT_EQ(parts_of(order), (std::vector<std::vector<std::string>>{{"base"}, {"lid, large", "pin"}}));
  EXPECT_LT((*order[1].direction - Eigen::Vector3d(0, 0.6, 0.8)).norm(), 1e-12);
  for (const std::string& text :
       {std::string("\xEF\xBB\xBFstep,part\n1,base\n2,lid\n2,pin\n"), std::string("step,part\r1,base\r2,lid\r2,pin"),
        std::string("step;part\n1;base\n2;lid\n2;pin\n"), std::string("step , part\n\n1 ,base\n 2,lid\n2,pin\n")})
    EXPECT_EQ(parts_of(read(text)), (std::vector<std::vector<std::string>>{{"base"}, {"lid", "pin"}})) << text;
  for (const auto& [text, problem] :
       {std::pair("part\na\n", ":1: the header needs"), std::pair("step,part\nnan,a\n", ":2: 'nan' is no"),
        std::pair("step,part\n1\n", ":2: no part is named"), std::pair("step,part\nx,a\n", ":2: 'x' is no"),
        std::pair("step,part\n1,a\n2,a\n", ":3: part 'a' is there twice"),
        std::pair("step,part,direction\n1,a,up\n", ":2: 'up' is no direction"),
        std::pair("step,part\n", "it holds no step")}) {
    try {
      read(text);
      FAIL() << text;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(problem), std::string::npos) << e.what();
    }
  }
  std::filesystem::remove(file);
}

/// Blocks stacked in a tube: from above, the last first.
TEST(Replay, StepsThatArePossibleAndOthers) {
  const Assembly assembly = fake::tube_with_blocks(3);
  const Verifier verifier(assembly, VerifyOptions{});
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const std::vector<ReferenceStep> good{{1, {0}, "", up}, {2, {1}, "", up}, {3, {2, 3}, "", up}};
  std::vector<ReplayedItem> items = replay(assembly, good, verifier, {});
  ASSERT_EQ(items.size(), 3u);
  for (const ReplayedItem& item : items) {
    EXPECT_TRUE(item.possible);
    EXPECT_LT((item.direction + up).norm(), 1e-9) << "they are put in from above";
  }
  EXPECT_EQ(items[0].parts.front(), 3u) << "of one step, the upper block has to be the first";
  const std::vector<ReferenceStep> wrong{{1, {0}, "", up}, {2, {3}, "", up}, {3, {2}, "", up}, {4, {1}, "", up}};
  items = replay(assembly, wrong, verifier, {});
  ASSERT_EQ(items.size(), 3u);
  EXPECT_FALSE(items[0].possible);
  EXPECT_GT(items[0].depth, 0.1);
  EXPECT_TRUE(items[0].measured);
  EXPECT_TRUE(items[2].possible);
  // Two blocks that are put in together, and were put together before.
  const std::vector<ReferenceStep> grouped{
      {1, {0}, "", up}, {1, {2}, "pair", up}, {2, {3}, "pair", up}, {2, {2, 3}, "", up}, {3, {1}, "", up}};
  items = replay(assembly, grouped, verifier, {});
  ASSERT_EQ(items.size(), 3u);
  EXPECT_FALSE(items[0].possible) << "the lowest block is below the pair";
  EXPECT_EQ(items[1].item, "pair");
  EXPECT_TRUE(items[1].possible);
  EXPECT_EQ(items[2].group, "pair");
  EXPECT_TRUE(items[2].possible);
}

/// Of the parts of a step, only what cannot leave by itself is refused, not what waits for it.
TEST(Replay, WhatWaitsForAnotherIsNotRefused) {
  const Assembly assembly = fake::tube_with_blocks(4);
  const Verifier verifier(assembly, VerifyOptions{});
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  // The uppermost block was there before: the two below it cannot be put in, the upper of them no more than the lower.
  const std::vector<ReferenceStep> order{{1, {0, 1, 4}, "", up}, {2, {2, 3}, "", up}};
  std::size_t told = 0;
  const std::vector<ReplayedItem> items =
      replay(assembly, order, verifier, {}, [&](const ReplayedItem& item) { told += item.parts.size(); });
  ASSERT_EQ(items.size(), 4u);
  EXPECT_EQ(told, 4u);
  for (std::size_t k : {0, 1}) {
    EXPECT_FALSE(items[k].possible);
    EXPECT_EQ(items[k].other, 4u) << "not the other block of the step";
  }
  for (std::size_t k : {2, 3}) EXPECT_TRUE(items[k].possible);
}

}  // namespace
}  // namespace dismantle
