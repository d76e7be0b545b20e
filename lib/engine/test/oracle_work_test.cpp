// What the oracle does only once, what it does speculatively, and what it does on several threads.
#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "dismantle/testing/oracle_rig.h"

namespace dismantle {
namespace {

using fake::leave;
using fake::outcome;
using fake::Rig;

TEST(Oracle, TheSameQuestionIsPlannedOnce) {
  int planned = 0;
  const auto counting = [&planned](const PathQuery& q, RunContext& c) {
    ++planned;
    return fake::push(q, c);
  };
  Rig s(fake::row(4), fake::setup(counting));
  Attempt a = leave(s.assembly, 1);
  const AttemptResult& first = s.ask(a);
  std::swap(a.fixed[0], a.fixed[2]);
  a.fixed[1].pose.q.coeffs() *= -1;  // the same rotation
  a.fixed[1].pose.t.x() = -0.0;
  EXPECT_EQ(&s.ask(a), &first);
  EXPECT_EQ(planned, 1);
  a.fixed.pop_back();  // another question
  s.ask(a);
  EXPECT_EQ(planned, 2);
  EXPECT_EQ(s.oracle->counts().attempts, 2u);
  EXPECT_EQ(s.oracle->counts().memoised, 1u);
}

TEST(Oracle, ColumnsAreInAscendingOrderHoweverPartsAreListed) {
  const auto fan = [](const PathQuery& q, RunContext&) {  // each part by its own way
    Path path = fake::straight(q.scene, {0, 0, 0});
    for (std::size_t i = 0; i < q.scene.moving.size(); ++i) path[1][i].t.z() = 10 + 10.0 * q.scene.moving[i].part;
    return fake::shown(q, path);
  };
  Rig s(fake::row(3), fake::setup(fan));
  Attempt a;
  a.moving = {{0, Pose{}}, {1, Pose{}}};
  a.fixed = {{2, Pose{}}};
  Attempt b = a;
  std::swap(b.moving[0], b.moving[1]);
  const AttemptResult& ra = s.ask(a);
  const AttemptResult& rb = s.ask(b);
  ASSERT_EQ(ra.result.outcome(), Outcome::solved);
  EXPECT_EQ(ra.result.path()->poses().back()[0].t.z(), 10);
  EXPECT_EQ(ra.result.path()->poses().back()[1].t.z(), 20);
  EXPECT_EQ(&ra, &rb) << "the same question";
  EXPECT_EQ(ra.attempt.moving[0].part, 0u);
  EXPECT_EQ(ra.attempt.moving[1].part, 1u);
  EXPECT_EQ(s.oracle->counts().attempts, 1u);
}

TEST(Oracle, WhatMoreDepthCannotChangeIsRemembered) {
  for (const auto& [said, remembered] : std::vector<std::pair<Outcome, bool>>{{Outcome::exhausted, true},
                                                                              {Outcome::timeout, true},
                                                                              {Outcome::unsupported, true},
                                                                              {Outcome::invalid_start, true},
                                                                              {Outcome::depth_limit, false},
                                                                              {Outcome::crashed, false}}) {
    int planned = 0;
    const auto fails = [&planned, said = said](const PathQuery&, RunContext&) {
      ++planned;
      return outcome(said);
    };
    Rig s(fake::row(2), fake::setup(fails));
    s.ask(leave(s.assembly, 0, 3));
    for (const unsigned depth : {4u, 5u, 0u}) EXPECT_EQ(s.ask(leave(s.assembly, 0, depth)).result.outcome(), said);
    EXPECT_EQ(planned, remembered ? 1 : 4);
    s.ask(leave(s.assembly, 1, 3));  // another part
    EXPECT_EQ(planned, remembered ? 2 : 5);
  }
}

TEST(Oracle, FailingDeepSaysNothingOfShallow) {
  int planned = 0;
  const auto fails = [&planned](const PathQuery&, RunContext&) {
    ++planned;
    return outcome(Outcome::exhausted);
  };
  Rig s(fake::row(2), fake::setup(fails));
  s.ask(leave(s.assembly, 0, 3));
  s.ask(leave(s.assembly, 0, 2));
  EXPECT_EQ(planned, 2);
}

TEST(Oracle, BudgetReachesThePlanner) {
  RunOptions options;
  options.path_steps = 77;
  options.path_timeout = 0;
  const auto looks = [](const PathQuery& q, RunContext&) {
    EXPECT_EQ(q.budget.max_steps, 77u);
    EXPECT_EQ(q.budget.max_depth, 5u);
    EXPECT_EQ(q.budget.timeout, 0);
    return outcome(Outcome::timeout);
  };
  Rig s(fake::row(2), fake::setup(looks), 1, options);
  EXPECT_EQ(s.ask(leave(s.assembly, 0, 5)).result.outcome(), Outcome::timeout);
}

TEST(Oracle, InterruptionsAreNotAnswers) {
  for (const unsigned threads : {1u, 3u}) {
    CancelToken stop;
    const auto interrupted = [&stop](const PathQuery& q, RunContext& c) {
      stop.cancel();  // the user, in the midst of it
      while (stop.cancelled() && !c.should_stop()) std::this_thread::yield();
      if (c.should_stop()) return outcome(Outcome::exhausted);  // a sloppy planner
      return fake::push(q, c);
    };
    Rig s(fake::row(2), fake::setup(interrupted), threads);
    RunContext impatient = s.context;
    impatient.cancel = stop;
    EXPECT_EQ(s.oracle->attempt(leave(s.assembly, 0), impatient).result.outcome(), Outcome::cancelled);
    EXPECT_EQ(s.oracle->attempt(leave(s.assembly, 0), impatient).result.outcome(), Outcome::cancelled);  // not begun
    EXPECT_EQ(s.oracle->counts().attempts, 0u);
    EXPECT_EQ(s.oracle->counts().memoised, 0u);
  }
}

TEST(Oracle, AfterTheDeadlineNothingIsBegun) {
  int planned = 0;
  const auto counting = [&planned](const PathQuery& q, RunContext& c) {
    ++planned;
    return fake::push(q, c);
  };
  Rig s(fake::row(2), fake::setup(counting));
  RunContext late = s.context;
  late.deadline = Deadline::after_seconds(0);
  EXPECT_EQ(s.oracle->attempt(leave(s.assembly, 0), late).result.outcome(), Outcome::timeout);
  EXPECT_EQ(planned, 0);
  EXPECT_EQ(s.ask(leave(s.assembly, 0)).result.outcome(), Outcome::solved);
  EXPECT_EQ(s.oracle->attempt(leave(s.assembly, 0), late).result.outcome(), Outcome::solved);  // from memory
}

PathResult draw(const PathQuery& q, RunContext& c) {
  PathResult r = fake::push(q, c);
  r.stats.extra["draw"] = c.rng.uniform();
  return r;
}

TEST(Oracle, AnswersDependNeitherOnOrderNorOnThreads) {
  const Assembly assembly = fake::row(6);
  std::vector<Attempt> questions;
  for (PartId id = 0; id < 6; ++id)
    for (const unsigned depth : {1u, 2u, 3u}) questions.push_back(leave(assembly, id, depth));
  std::vector<double> expected;
  {
    Rig s(assembly, fake::setup(draw));
    for (const auto& q : questions) expected.push_back(s.ask(q).result.stats.extra.at("draw"));
    EXPECT_EQ(std::set<double>(expected.begin(), expected.end()).size(), expected.size());
  }
  for (const unsigned threads : {1u, 2u, 4u})
    for (const bool hint : {false, true}) {
      Rig s(assembly, fake::setup(draw), threads);
      if (hint) s.oracle->prefetch(questions, s.context);
      for (std::size_t i = questions.size(); i-- > 0;) {
        EXPECT_EQ(s.ask(questions[i]).result.stats.extra.at("draw"), expected[i]);
      }
      EXPECT_EQ(s.oracle->counts().attempts, questions.size());
      EXPECT_EQ(s.oracle->counts().memoised, 0u);
      EXPECT_EQ(s.oracle->counts().discarded, 0u);
    }
}

/// The number of attempts in progress, and its maximum.
struct Crowd {
  std::atomic<int> now{0}, most{0};
  void enter() {
    const int n = ++now;
    int seen = most;
    while (n > seen && !most.compare_exchange_weak(seen, n)) {
    }
  }
};

TEST(Oracle, NeverMoreAttemptsAtOnceThanThreads) {
  Crowd crowd;
  const auto busy = [&](const PathQuery& q, RunContext& c) {
    crowd.enter();
    std::this_thread::yield();
    PathResult r = fake::push(q, c);
    --crowd.now;
    return r;
  };
  Rig s(fake::row(8), fake::setup(busy), 3);
  std::vector<Attempt> hints;
  for (PartId id = 0; id < 8; ++id) hints.push_back(leave(s.assembly, id));
  s.oracle->prefetch(hints, s.context);
  for (const auto& h : hints) s.ask(h);
  EXPECT_LE(crowd.most, 3);
}

TEST(Oracle, LeavesAThreadToTheAskerWhoIsNotWaiting) {
  Crowd crowd;
  const auto patient = [&](const PathQuery& q, RunContext& c) {  // until there are three, or for a while
    crowd.enter();
    for (int k = 0; k < 2000 && crowd.now < 3; ++k) std::this_thread::yield();
    PathResult r = fake::push(q, c);
    --crowd.now;
    return r;
  };
  Rig s(fake::row(8), fake::setup(patient), 3);
  std::vector<Attempt> hints;
  for (PartId id = 0; id < 8; ++id) hints.push_back(leave(s.assembly, id));
  s.oracle->prefetch(hints, s.context);
  while (s.oracle->counts().discarded < 8) std::this_thread::yield();
  EXPECT_EQ(crowd.most, 2);
}

/// A concurrent planner is created once and used by all threads at the same time; otherwise each thread has its own.
TEST(Oracle, AConcurrentPlannerServesAllThreads) {
  for (const bool concurrent : {true, false}) {
    std::atomic<int> made{0};
    Crowd crowd;
    class Patient final : public FunctionPathPlanner {
     public:
      Patient(bool is, Crowd& crowd) : concurrent_(is), crowd_(crowd) {}
      PathPlannerTraits traits() const noexcept override { return {.concurrent = concurrent_}; }
      PathResult plan(const PathQuery& q, RunContext& c) override {
        crowd_.enter();
        for (int k = 0; k < 1'000'000 && crowd_.most < 2; ++k) std::this_thread::yield();
        PathResult r = fake::push(q, c);
        --crowd_.now;
        return r;
      }

     private:
      const bool concurrent_;
      Crowd& crowd_;
    };
    PlanningSetup parts = fake::setup(fake::push);
    parts.path_planner = [&] {
      ++made;
      return std::make_shared<Patient>(concurrent, crowd);
    };
    Rig s(fake::row(8), parts, 3);
    std::vector<Attempt> hints;
    for (PartId id = 0; id < 8; ++id) hints.push_back(leave(s.assembly, id));
    s.oracle->prefetch(hints, s.context);
    for (const auto& h : hints) EXPECT_EQ(s.ask(h).result.outcome(), Outcome::solved);
    EXPECT_GE(crowd.most, 2);
    if (concurrent)
      EXPECT_EQ(made, 1);
    else
      EXPECT_GE(made, 2);
  }
}

/// Part 0 never ends by itself.
PathResult endless(const PathQuery& q, RunContext& c) {
  if (q.scene.moving[0].part != 0) return fake::push(q, c);
  while (!c.should_stop()) std::this_thread::yield();
  return outcome(Outcome::cancelled);
}

TEST(Oracle, WorkNobodyAskedForMakesWay) {
  Rig s(fake::row(5), fake::setup(endless), 2);
  std::vector<Attempt> hints;
  for (const unsigned depth : {1u, 2u, 3u, 4u}) hints.push_back(leave(s.assembly, 0, depth));
  s.oracle->prefetch(hints, s.context);  // both threads are stuck
  for (PartId id = 1; id < 5; ++id) EXPECT_EQ(s.ask(leave(s.assembly, id)).result.outcome(), Outcome::solved);
  s.oracle->prefetch({}, s.context);
  EXPECT_EQ(s.oracle->counts().attempts, 4u);
  EXPECT_TRUE(s.errors.empty());
}

TEST(Oracle, EndsWhileThreadsWork) {
  for (int trial = 0; trial < 20; ++trial) {
    Rig s(fake::row(4), fake::setup(endless), 3);
    s.oracle->prefetch(std::vector<Attempt>{leave(s.assembly, 0), leave(s.assembly, 1), leave(s.assembly, 0, 1)},
                       s.context);
    s.oracle.reset();
  }
}

TEST(Oracle, CountsWhatWasComputedAheadInVain) {
  std::atomic<int> ended{0};
  const auto counting = [&](const PathQuery& q, RunContext& c) {
    PathResult r = fake::push(q, c);
    ++ended;
    return r;
  };
  Rig s(fake::row(3), fake::setup(counting), 2);
  s.oracle->prefetch(std::vector<Attempt>{leave(s.assembly, 0), leave(s.assembly, 1)}, s.context);
  while (s.oracle->counts().discarded < 2) std::this_thread::yield();
  EXPECT_EQ(ended, 2);
  EXPECT_EQ(s.oracle->counts().attempts, 0u);
  s.ask(leave(s.assembly, 1));
  EXPECT_EQ(ended, 2);  // it was there already
  EXPECT_EQ(s.oracle->counts().attempts, 1u);
  EXPECT_EQ(s.oracle->counts().discarded, 1u);
}

TEST(Oracle, LogsOfWorkAheadAppearWhenAsked) {
  const auto talks = [](const PathQuery& q, RunContext& c) {
    c.log(LogLevel::error, "part " + std::to_string(q.scene.moving[0].part));
    return outcome(Outcome::exhausted);
  };
  Rig s(fake::row(3), fake::setup(talks), 2);
  s.oracle->prefetch(std::vector<Attempt>{leave(s.assembly, 0), leave(s.assembly, 1)}, s.context);
  while (s.oracle->counts().discarded < 2) std::this_thread::yield();
  EXPECT_TRUE(s.errors.empty());
  s.ask(leave(s.assembly, 1));
  EXPECT_EQ(s.errors, (std::vector<std::string>{"part 1"}));
}

}  // namespace
}  // namespace dismantle
