// Attempts that resume an earlier one.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "dismantle/testing/oracle_rig.h"

namespace dismantle {
namespace {

using fake::Rig;

Attempt resuming(const Assembly& assembly, PartId part, unsigned max_depth = 0) {
  Attempt attempt = fake::leave(assembly, part, max_depth);
  attempt.resume = true;
  return attempt;
}

Attempt without(Attempt attempt, PartId out) {
  std::erase_if(attempt.fixed, [&](const PlacedPart& p) { return p.part == out; });
  return attempt;
}

double length(const AttemptResult& answer) { return answer.result.stats.extra.at("length"); }

/// The number of searches so far, and a random number drawn by each.
struct Chain final : SearchState {
  int length = 0;
  double drawn = 0;
};

/// Never finds a path, and keeps its state.
PathResult in_vain(const PathQuery& query, RunContext& context) {
  const auto* before = dynamic_cast<const Chain*>(query.resume_from);
  auto chain = std::make_shared<Chain>();
  chain->length = 1 + (before != nullptr ? before->length : 0);
  chain->drawn = context.rng.uniform() + (before != nullptr ? 10 * before->drawn : 0);
  PathResult r = fake::outcome(Outcome::depth_limit);
  r.stats.extra["length"] = chain->length;
  r.stats.extra["drawn"] = chain->drawn;
  r.state = chain;
  return r;
}

TEST(OracleResume, ThePlannerIsGivenTheStateOfTheLastSearch) {
  Rig s(fake::row(4), fake::setup(in_vain));
  EXPECT_EQ(length(s.ask(resuming(s.assembly, 0, 1))), 1);
  EXPECT_EQ(length(s.ask(resuming(s.assembly, 0, 2))), 2);
  EXPECT_EQ(length(s.ask(without(resuming(s.assembly, 0, 2), 3))), 3);
  EXPECT_EQ(s.oracle->counts().attempts, 3u);
}

TEST(OracleResume, TheSameAttemptAgainHasTheSameAnswer) {
  Rig s(fake::row(4), fake::setup(in_vain));
  const AttemptResult& one = s.ask(resuming(s.assembly, 0, 1));
  EXPECT_EQ(&s.ask(resuming(s.assembly, 0, 1)), &one);
  const AttemptResult& two = s.ask(resuming(s.assembly, 0, 2));
  EXPECT_EQ(&s.ask(resuming(s.assembly, 0, 2)), &two);
  EXPECT_EQ(s.oracle->counts().memoised, 2u);
  // The resumed search is part of the question: this one resumes the last one.
  const AttemptResult& one_after_two = s.ask(resuming(s.assembly, 0, 1));
  EXPECT_NE(&one_after_two, &one);
  EXPECT_EQ(length(one_after_two), 3);
}

TEST(OracleResume, AttemptsThatDoNotAskForItBeginAnewAndLeaveNothing) {
  Rig s(fake::row(4), fake::setup(in_vain));
  const AttemptResult& first = s.ask(fake::leave(s.assembly, 0, 1));
  EXPECT_EQ(first.result.state, nullptr);
  EXPECT_EQ(length(s.ask(resuming(s.assembly, 0, 2))), 1);
  EXPECT_EQ(length(s.ask(fake::leave(s.assembly, 0, 3))), 1);
  EXPECT_EQ(length(s.ask(resuming(s.assembly, 0, 4))), 2);
}

TEST(OracleResume, WhereNothingWasKeptItIsTheQuestionFromTheStart) {
  const auto keeps_nothing = [](const PathQuery& query, RunContext&) {
    EXPECT_EQ(query.resume_from, nullptr);
    return fake::outcome(Outcome::depth_limit);
  };
  Rig s(fake::row(4), fake::setup(keeps_nothing));
  s.ask(resuming(s.assembly, 0, 1));
  const AttemptResult& deeper = s.ask(resuming(s.assembly, 0, 2));
  EXPECT_EQ(&s.ask(fake::leave(s.assembly, 0, 2)), &deeper);
}

/// Resumes the latest of several searches that had at least the present fixed parts at their present poses.
TEST(OracleResume, OnlyStatesThatCanStillBeReachedAreTakenOver) {
  Rig s(fake::row(4), fake::setup(in_vain));
  const Attempt all = resuming(s.assembly, 0, 1);
  EXPECT_EQ(length(s.ask(all)), 1);
  EXPECT_EQ(length(s.ask(without(all, 2))), 2);
  EXPECT_EQ(length(s.ask(without(without(all, 2), 3))), 3);
  Attempt now = all;
  now.max_depth = 2;
  EXPECT_EQ(length(s.ask(now)), 2) << "from the first: part 2 was not there in the later ones";
  now = without(all, 1);
  EXPECT_EQ(length(s.ask(now)), 3) << "from the last that had part 2";
  EXPECT_EQ(length(s.ask(resuming(s.assembly, 1, 1))), 1) << "another part";
  now = all;
  now.fixed[0].pose.t.x() += 0.25;
  EXPECT_EQ(length(s.ask(now)), 1) << "one that is elsewhere now";
  now = all;
  now.moving[0].pose.t.x() += 0.25;
  EXPECT_EQ(length(s.ask(now)), 1) << "from another place";
}

TEST(OracleResume, SuccessLeavesNothingToResume) {
  const auto finds = [](const PathQuery& query, RunContext& context) {
    PathResult r = fake::push(query, context);
    r.state = std::make_shared<Chain>();
    EXPECT_EQ(query.resume_from, nullptr);
    return r;
  };
  Rig s(fake::row(3), fake::setup(finds));
  const AttemptResult& out = s.ask(resuming(s.assembly, 0, 1));
  ASSERT_EQ(out.result.outcome(), Outcome::solved);
  EXPECT_EQ(out.result.state, nullptr);
  s.ask(resuming(s.assembly, 0, 2));
}

/// Chains of searches, each resuming the last while other parts leave: the same on any number of threads, hinted
/// or not, in any order of the parts.
TEST(OracleResume, TheSameOnAnyNumberOfThreads) {
  const Assembly assembly = fake::row(6);
  const auto chains = [&](unsigned threads, bool hint, bool backwards) {
    Rig s(assembly, fake::setup(in_vain), threads);
    std::vector<double> drawn(5, 0);
    std::vector<const AttemptResult*> last(5, nullptr);
    const auto question = [&](PartId part, unsigned depth) {
      const Attempt a = resuming(assembly, part, depth);
      return depth > 2 ? without(a, 5) : a;
    };
    for (const unsigned depth : {1u, 2u, 3u, 4u}) {
      std::vector<Attempt> all;
      for (PartId part = 0; part < 5; ++part) all.push_back(question(part, depth));
      if (hint) s.oracle->prefetch(all, s.context);
      for (PartId k = 0; k < 5; ++k) {
        const PartId part = backwards ? 4 - k : k;
        last[part] = &s.ask(question(part, depth));
        drawn[part] = last[part]->result.stats.extra.at("drawn");
      }
    }
    for (const AttemptResult* answer : last) EXPECT_EQ(answer->result.stats.extra.at("length"), 4);
    return drawn;
  };
  const std::vector<double> expected = chains(1, false, false);
  for (const unsigned threads : {1u, 2u, 4u})
    for (const bool hint : {false, true})
      for (const bool backwards : {false, true}) EXPECT_EQ(chains(threads, hint, backwards), expected);
}

}  // namespace
}  // namespace dismantle
