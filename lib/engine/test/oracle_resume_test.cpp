// Attempts that go on from what an earlier one has reached.
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include "dismantle/testing/oracle_rig.h"

namespace dismantle {
namespace {

using fake::Rig;

Attempt keeping(const Assembly& assembly, PartId part, unsigned max_depth = 0) {
  Attempt attempt = fake::leave(assembly, part, max_depth);
  attempt.keep_reached = true;
  return attempt;
}

/// How many searches it took to come there, and a number drawn by each.
struct Chain final : Reached {
  int length = 0;
  double drawn = 0;
};

/// Never finds anything, and keeps what it had.
PathResult in_vain(const PathQuery& query, RunContext& context) {
  const auto* before = dynamic_cast<const Chain*>(query.reached);
  auto chain = std::make_shared<Chain>();
  chain->length = 1 + (before != nullptr ? before->length : 0);
  chain->drawn = context.rng.uniform() + (before != nullptr ? 10 * before->drawn : 0);
  PathResult r = fake::outcome(Outcome::depth_limit);
  r.counts["length"] = chain->length;
  r.counts["drawn"] = chain->drawn;
  r.reached = chain;
  return r;
}

Attempt after(Attempt attempt, const AttemptResult& earlier, std::optional<PartId> out = {}) {
  attempt.after = &earlier;
  if (out) std::erase_if(attempt.still, [&](const PlacedPart& p) { return p.part == *out; });
  return attempt;
}

TEST(OracleResume, ThePlannerIsGivenWhatTheEarlierOneReached) {
  Rig s(fake::row(4), fake::ingredients(in_vain));
  const AttemptResult& first = s.ask(keeping(s.assembly, 0, 1));
  EXPECT_EQ(first.result.counts.at("length"), 1);
  const AttemptResult& deeper = s.ask(after(keeping(s.assembly, 0, 2), first));
  EXPECT_EQ(deeper.result.counts.at("length"), 2);
  const AttemptResult& fewer = s.ask(after(keeping(s.assembly, 0, 2), deeper, PartId{3}));
  EXPECT_EQ(fewer.result.counts.at("length"), 3);
  EXPECT_EQ(s.oracle->counts().attempts, 3u);
}

TEST(OracleResume, WhatItGoesOnFromIsPartOfTheQuestion) {
  Rig s(fake::row(4), fake::ingredients(in_vain));
  const AttemptResult& one = s.ask(keeping(s.assembly, 0, 1));
  const AttemptResult& two = s.ask(keeping(s.assembly, 0, 2));
  const Attempt question = keeping(s.assembly, 0, 3);
  const AttemptResult& anew = s.ask(question);
  const AttemptResult &after_one = s.ask(after(question, one)), &after_two = s.ask(after(question, two));
  EXPECT_NE(&anew, &after_one);
  EXPECT_NE(&after_one, &after_two);
  EXPECT_EQ(&s.ask(after(question, one)), &after_one);
  EXPECT_EQ(&s.ask(question), &anew);
  EXPECT_EQ(s.oracle->counts().memoised, 2u);
  // So is what that one went on from.
  const AttemptResult& two_after_one = s.ask(after(keeping(s.assembly, 0, 2), one));
  EXPECT_NE(&s.ask(after(question, two_after_one)), &after_two);
  EXPECT_EQ(s.ask(after(question, two_after_one)).result.counts.at("length"), 3);
}

TEST(OracleResume, WhereNothingWasKeptItIsTheQuestionFromTheStart) {
  const auto keeps_nothing = [](const PathQuery& query, RunContext&) {
    EXPECT_EQ(query.reached, nullptr);
    return fake::outcome(Outcome::depth_limit);
  };
  Rig s(fake::row(4), fake::ingredients(keeps_nothing));
  const AttemptResult& first = s.ask(keeping(s.assembly, 0, 1));
  const AttemptResult& deeper = s.ask(after(keeping(s.assembly, 0, 2), first));
  EXPECT_EQ(&s.ask(keeping(s.assembly, 0, 2)), &deeper);
}

TEST(OracleResume, WhereNobodyWantsToGoOnNothingIsKept) {
  Rig s(fake::row(4), fake::ingredients(in_vain));
  const AttemptResult& first = s.ask(fake::leave(s.assembly, 0, 1));
  EXPECT_EQ(first.result.reached, nullptr);
  EXPECT_EQ(s.ask(after(keeping(s.assembly, 0, 2), first)).result.counts.at("length"), 1);
}

TEST(OracleResume, OnlyStatesThatCanStillBeReachedAreTakenOver) {
  Rig s(fake::row(4), fake::ingredients(in_vain)), other(fake::row(4), fake::ingredients(in_vain));
  const Attempt all = keeping(s.assembly, 0, 1);
  const AttemptResult& first = s.ask(all);
  const AttemptResult& fewer = s.ask(after(all, first, PartId{2}));
  EXPECT_THROW(s.ask(after(all, fewer)), std::invalid_argument) << "part 2 was not there then";
  EXPECT_THROW(s.ask(after(keeping(s.assembly, 1, 1), first)), std::invalid_argument) << "another part";
  EXPECT_THROW(s.ask(after(all, other.ask(all))), std::invalid_argument) << "of another oracle";
  Attempt moved = after(all, first);
  moved.still[0].pose.t.x() += 0.25;
  EXPECT_THROW(s.ask(moved), std::invalid_argument) << "one that stands elsewhere now";
  moved = after(all, first);
  moved.moving[0].pose.t.x() += 0.25;
  EXPECT_THROW(s.ask(moved), std::invalid_argument) << "from another place";
  EXPECT_EQ(s.oracle->counts().attempts, 2u);
}

TEST(OracleResume, SuccessLeavesNothingToGoOnFrom) {
  const auto finds = [](const PathQuery& query, RunContext& context) {
    PathResult r = fake::push(query, context);
    r.reached = std::make_shared<Chain>();
    return r;
  };
  Rig s(fake::row(3), fake::ingredients(finds));
  const AttemptResult& out = s.ask(keeping(s.assembly, 0));
  ASSERT_EQ(out.result.outcome, Outcome::solved);
  EXPECT_EQ(out.result.reached, nullptr);
  EXPECT_THROW(s.ask(after(keeping(s.assembly, 0), out)), std::invalid_argument);
}

/// Chains of searches, each going on from the last while other parts leave: the same on any number of threads, hinted
/// or not, in any order of the parts.
TEST(OracleResume, TheSameOnAnyNumberOfThreads) {
  const Assembly assembly = fake::row(6);
  const auto chains = [&](unsigned threads, bool hint, bool backwards) {
    Rig s(assembly, fake::ingredients(in_vain), threads);
    std::vector<double> drawn(5, 0);
    std::vector<const AttemptResult*> last(5, nullptr);
    const auto question = [&](PartId part, unsigned depth) {
      Attempt a = keeping(assembly, part, depth);
      if (depth > 2) a = after(a, *last[part], PartId{5});
      a.after = last[part];
      return a;
    };
    for (const unsigned depth : {1u, 2u, 3u, 4u}) {
      std::vector<Attempt> all;
      for (PartId part = 0; part < 5; ++part) all.push_back(question(part, depth));
      if (hint) s.oracle->prefetch(all, s.context);
      for (PartId k = 0; k < 5; ++k) {
        const PartId part = backwards ? 4 - k : k;
        last[part] = &s.ask(question(part, depth));
        drawn[part] = last[part]->result.counts.at("drawn");
      }
    }
    for (const AttemptResult* answer : last) EXPECT_EQ(answer->result.counts.at("length"), 4);
    return drawn;
  };
  const std::vector<double> expected = chains(1, false, false);
  for (const unsigned threads : {1u, 2u, 4u})
    for (const bool hint : {false, true})
      for (const bool backwards : {false, true}) EXPECT_EQ(chains(threads, hint, backwards), expected);
}

}  // namespace
}  // namespace dismantle
