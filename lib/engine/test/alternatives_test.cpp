// Questions asked again for another answer: without a direction, with another seed, the best of several, improved.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <set>
#include <stdexcept>
#include <vector>

#include "dismantle/testing/oracle_rig.h"

namespace dismantle {
namespace {

using fake::Rig;

Eigen::Vector3d direction(const AttemptResult& answer) {
  return (answer.path().back()[0].t - answer.path().front()[0].t).normalized();
}

double travel(const AttemptResult& answer) { return (answer.path().back()[0].t - answer.path().front()[0].t).norm(); }

/// Leaves along -y (free in a row of blocks) by a random distance that separates the hulls.
PathResult random_distance(const PathQuery& query, RunContext& context) {
  return fake::shown(query, fake::straight(query.scene, -Eigen::Vector3d::UnitY() * (2 + 20 * context.rng.uniform())));
}

/// A block in a row can leave in five directions. Each time one is excluded, it leaves in another, until none is left.
TEST(Alternatives, WithoutADirection) {
  Rig s(fake::row(3), fake::setup(fake::push));
  Attempt question = fake::leave(s.assembly, 0);
  for (int found = 0; found < 5; ++found) {
    const AttemptResult& answer = s.ask(question);
    ASSERT_TRUE(is_success(answer.result.outcome())) << found;
    for (const Eigen::Vector3d& d : question.goal.without)
      EXPECT_LE(direction(answer).dot(d), std::cos(question.goal.angle) + 1e-12);
    EXPECT_EQ(&s.ask(question), &answer) << "asked again, it is the same question";
    question.goal.without.push_back(direction(answer));
  }
  const AttemptResult& none = s.ask(question);
  EXPECT_EQ(none.result.outcome(), Outcome::exhausted);
  EXPECT_EQ(none.certificate, nullptr) << "it can leave, so nothing is to be proved";
}

/// Directions nearer than the angle are excluded, others are not.
TEST(Alternatives, TheAngleDecides) {
  const auto down = [](const PathQuery& query, RunContext&) {
    return fake::shown(query, fake::straight(query.scene, -5 * Eigen::Vector3d::UnitY()));
  };
  for (const double off : {0.1, 0.24, 0.26, 1.0}) {
    Rig s(fake::row(3), fake::setup(down));
    Attempt question = fake::leave(s.assembly, 1);
    question.goal.without = {{std::sin(off), -std::cos(off), 0}};
    EXPECT_EQ(is_success(s.ask(question).result.outcome()), off > question.goal.angle) << off;
    question.goal.angle = 2 * off;
    EXPECT_FALSE(is_success(s.ask(question).result.outcome())) << off;
    question.goal.angle = off / 2;
    EXPECT_TRUE(is_success(s.ask(question).result.outcome())) << off;
  }
}

TEST(Alternatives, AProposalKeepsToThemToo) {
  Rig s(fake::row(3), fake::setup(fake::push));
  Attempt question = fake::leave(s.assembly, 1);
  const Path down = fake::straight({question.moving, question.fixed}, -5 * Eigen::Vector3d::UnitY());
  EXPECT_TRUE(is_success(s.oracle->propose(question, down, s.context).result.outcome()));
  question.goal.without = {-Eigen::Vector3d::UnitY()};
  const AttemptResult& refused = s.oracle->propose(question, down, s.context);
  EXPECT_FALSE(is_success(refused.result.outcome()));
  EXPECT_NE(refused.result.message.find("excludes"), std::string::npos) << refused.result.message;
}

/// Each seed is a question of its own with its own random numbers; the best of k is the shortest of k of them.
TEST(Alternatives, TheBestOfSeveralSeeds) {
  Rig s(fake::row(3), fake::setup(random_distance));
  Attempt question = fake::leave(s.assembly, 0);
  std::set<double> lengths;
  for (question.seed = 0; question.seed < 8; ++question.seed) lengths.insert(travel(s.ask(question)));
  EXPECT_EQ(lengths.size(), 8u);
  const std::uint64_t asked = s.oracle->counts().attempts;
  question.seed = 0;
  question.best_of = 8;
  const AttemptResult& best = s.ask(question);
  EXPECT_EQ(travel(best), *lengths.begin());
  EXPECT_EQ(s.oracle->counts().attempts, asked) << "the answers are remembered";
  question.best_of = 9;
  EXPECT_LE(travel(s.ask(question)), travel(best));
  EXPECT_EQ(s.oracle->counts().attempts, asked + 1);
}

/// The same on any number of threads, hinted or not.
TEST(Alternatives, TheSameOnAnyNumberOfThreads) {
  const auto lengths = [](unsigned threads, bool hint) {
    Rig s(fake::row(6), fake::setup(random_distance), threads);
    std::vector<Attempt> questions;
    for (PartId part = 0; part < 6; ++part) {
      questions.push_back(fake::leave(s.assembly, part));
      questions.back().best_of = 1 + part;
      questions.back().seed = part % 3;
    }
    if (hint) s.oracle->prefetch(questions, s.context);
    std::vector<double> all;
    for (const Attempt& q : questions) all.push_back(travel(s.ask(q)));
    return all;
  };
  const std::vector<double> expected = lengths(1, false);
  for (const unsigned threads : {2u, 4u})
    for (const bool hint : {false, true}) EXPECT_EQ(lengths(threads, hint), expected) << threads;
}

/// Goes 10 further than needed, and with each further run of 10 state checks 1 less, down to 4.
class Improving final : public PathPlanner {
 public:
  PathPlannerTraits traits() const noexcept override { return {}; }
  std::unique_ptr<PathSearch> start(const PathQuery& query, RunContext&) override {
    struct Search final : PathSearch {
      explicit Search(const PathQuery& q) : query(q) {}
      SearchStatus run(const Budget&) override {
        state.stats.state_checks += 10;
        PathResult next = fake::shown(query, fake::straight(query.scene, -distance * Eigen::Vector3d::UnitY()));
        next.stats = state.stats;
        next.may_improve = distance > 4;
        distance -= 1;
        state = next;
        return SearchStatus::solved;
      }
      PathResult result() override { return state; }
      const PathQuery& query;
      PathResult state;
      double distance = 10;
    };
    return std::make_unique<Search>(query);
  }
};

TEST(Alternatives, ASearchThatMayImproveGoesOnWithinItsSteps) {
  PlanningSetup setup = fake::setup(fake::push);
  setup.path_planner = [] { return std::make_shared<Improving>(); };
  Rig s(fake::row(3), setup);
  Attempt question = fake::leave(s.assembly, 1);
  for (const auto& [steps, expected] : {std::pair{0, 10.0}, {1, 9.0}, {10, 9.0}, {35, 6.0}, {1000, 4.0}}) {
    question.improve_steps = static_cast<std::uint64_t>(steps);
    const AttemptResult& answer = s.ask(question);
    EXPECT_EQ(travel(answer), expected) << steps;
    EXPECT_EQ(answer.result.stats.state_checks, static_cast<std::uint64_t>(10 * (11 - expected))) << steps;
  }
}

/// An anytime planner that is one function knows when another call may follow, and is called again only if asked to.
TEST(Alternatives, AnytimeFunctionsSeeTheirPortion) {
  int calls = 0;
  const auto anytime = [&calls](const PathQuery& query, RunContext&) {
    ++calls;
    PathResult result = fake::shown(query, fake::straight(query.scene, -(12.0 - calls) * Eigen::Vector3d::UnitY()));
    result.stats.state_checks = static_cast<std::uint64_t>(calls);
    result.may_improve = calls < 4;
    EXPECT_EQ(query.portion, calls > 1) << "a further call has a portion of the effort";
    return result;
  };
  Rig s(fake::row(3), fake::setup(anytime));
  Attempt question = fake::leave(s.assembly, 1);
  EXPECT_EQ(travel(s.ask(question)), 11);
  calls = 0;
  question.improve_steps = 100;
  EXPECT_EQ(travel(s.ask(question)), 8);
  EXPECT_EQ(calls, 4);
}

TEST(Alternatives, IllFormedQuestionsAreRefused) {
  Rig s(fake::row(3), fake::setup(fake::push));
  const auto refused = [&](auto change) {
    Attempt question = fake::leave(s.assembly, 0);
    change(question);
    EXPECT_THROW(s.ask(question), std::invalid_argument);
  };
  refused([](Attempt& a) { a.best_of = 0; });
  refused([](Attempt& a) { a.goal.without = {{0, 0, 2}}; });
  refused([](Attempt& a) { a.goal.without = {{0, 0, std::nan("")}}; });
  for (const double angle : {0.0, -1.0, 3.2, std::nan("")})
    refused([&](Attempt& a) { a.goal.without = {{0, 0, 1}}, a.goal.angle = angle; });
  refused([](Attempt& a) { a.goal.without = {{0, 0, 1}}, a.goal.placement = true; });
}

}  // namespace
}  // namespace dismantle
