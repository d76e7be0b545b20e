// The time limit of an attempt covers the search alone: no proofs, before, in the pauses of, or after the search.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "dismantle/run_context.h"
#include "dismantle/testing/fake_prover.h"
#include "dismantle/testing/oracle_rig.h"
#include "dismantle/testing/run_rig.h"

namespace dismantle {
namespace {

using fake::leave;
using fake::outcome;
using fake::Rig;
using fake::row;

using TestClock = std::chrono::steady_clock;

constexpr double kAttemptLimit = 1000;
constexpr ProverTraits kSomeProver{ProofEffort::low, 2, 2, false};

double in_seconds(TestClock::duration d) { return std::chrono::duration<double>(d).count(); }

template <class Search>
PlanningSetup search_with_proofs(const Search& search, const NamedProver& prover) {
  PlanningSetup setup = fake::setup(search);
  setup.provers = {prover};
  return setup;
}

TEST(AttemptTime, TimeOfProofsIsNotThatOfTheAttempt) {
  TestClock::time_point begin, end;
  double limit_of_proof = 0;
  const NamedProver prover =
      fake::prover("p", kSomeProver, [&](const SeparationQuery&, const RunContext& c) -> std::optional<Certificate> {
        begin = TestClock::now();
        limit_of_proof = c.deadline.seconds_left();
        end = TestClock::now();
        return std::nullopt;
      });
  RunOptions options;
  options.path_timeout = kAttemptLimit;
  Rig s(row(2), search_with_proofs([](const PathQuery&, RunContext&) { return outcome(Outcome::exhausted); }, prover),
        1, options);
  const AttemptResult& r = s.ask(leave(s.assembly, 0, 3));
  EXPECT_GT(limit_of_proof, kAttemptLimit) << "the limit is that of the search";
  EXPECT_GE(r.proof_seconds, in_seconds(end - begin));
}

/// The time that a search has left after a proof in its pause: its limit, less what the search itself has used.
TEST(AttemptTime, AProofInAPauseUsesUpNoTimeOfTheSearch) {
  TestClock::time_point after;
  double proof = 0, left = 0;
  int searches = 0;
  const auto search = [&](const PathQuery& query, RunContext& context) {
    if (++searches == 1) return outcome(Outcome::timeout);  // needs more steps than there are before the pause
    left = context.deadline.seconds_left();
    if (query.budget.timeout > 0) left = std::min(left, query.budget.timeout);
    after = TestClock::now();
    return outcome(Outcome::exhausted);
  };
  const NamedProver slow =
      fake::prover("p", kSomeProver, [&](const SeparationQuery&, const RunContext&) -> std::optional<Certificate> {
        const TestClock::time_point begin = TestClock::now();
        while (TestClock::now() - begin < std::chrono::milliseconds(50)) std::this_thread::yield();
        proof = in_seconds(TestClock::now() - begin);
        return std::nullopt;
      });
  RunOptions options;
  options.path_timeout = kAttemptLimit;
  Rig s(row(2), search_with_proofs(search, slow), 1, options);
  const TestClock::time_point before = TestClock::now();
  s.ask(leave(s.assembly, 0, 3));
  ASSERT_EQ(searches, 2);
  EXPECT_LE(left, kAttemptLimit);
  EXPECT_GE(left, kAttemptLimit - (in_seconds(after - before) - proof));
}

/// Such a search ends when its steps are used up, although time is left.
TEST(AttemptTime, ASearchWithPausesEndsWithItsSteps) {
  RunOptions options;
  options.path_timeout = kAttemptLimit;
  options.path_steps = static_cast<std::uint64_t>(options.proofs.low_effort_steps) + 1;
  int searches = 0, proofs = 0;
  const auto search = [&searches](const PathQuery&, RunContext&) {
    if (++searches > 2) throw std::logic_error("repeated without an end");
    return outcome(Outcome::timeout);
  };
  const NamedProver low = fake::prover("l", kSomeProver, [&proofs](const SeparationQuery&, const RunContext&) {
    ++proofs;
    return std::optional<Certificate>();
  });
  Rig s(row(2), search_with_proofs(search, low), 1, options);
  EXPECT_EQ(s.ask(leave(s.assembly, 0, 3)).result.outcome(), Outcome::timeout);
  EXPECT_EQ(searches, 2);
  EXPECT_EQ(proofs, 1);
}

}  // namespace
}  // namespace dismantle
