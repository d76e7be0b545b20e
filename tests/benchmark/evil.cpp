// Path planners that misbehave, and one that gives up immediately.
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "dismantle/plugin.h"

namespace {

using dismantle::Outcome;
using dismantle::PathQuery;
using dismantle::PathResult;
using dismantle::RunContext;

struct NoParameters {
  static void describe(dismantle::Schema<NoParameters>&) {}
};

template <PathResult (*kDo)()>
class Planner final : public dismantle::FunctionPathPlanner {
 public:
  explicit Planner(const NoParameters&) {}
  dismantle::PathPlannerTraits traits() const noexcept override { return {}; }
  PathResult plan(const PathQuery&, RunContext&) override { return kDo(); }
};

PathResult give_up() { return PathResult::failure(Outcome::exhausted); }

PathResult abort_at_once() {
  static const char words[] = "evil.abort says goodbye\n";
  if (::write(STDERR_FILENO, words, sizeof words - 1) < 0) return give_up();
  std::abort();
}

PathResult spin() {
  for (std::atomic<unsigned> i = 0;; ++i) {
  }
}

PathResult sleep_for_ever() {
  static const char words[] = "evil.sleep begins\n";
  if (::write(STDERR_FILENO, words, sizeof words - 1) < 0) return give_up();
  for (;;) ::pause();
}

PathResult eat_memory() {
  std::vector<std::vector<char>> eaten;
  for (;;) eaten.emplace_back(std::size_t{1} << 20, 'x');
}

PathResult scribble() {
  // Over the stack, upwards: return addresses and all.
  char here = 0;
  volatile char* at = &here;
  for (;; ++at) *at = here;
}

/// Leaves a process behind that belongs to another session, and says which.
PathResult leave_a_daemon() {
  const pid_t daemon = ::fork();
  if (daemon == 0) {
    ::setsid();
    for (;;) ::pause();
  }
  ::dprintf(STDERR_FILENO, "evil.daemon leaves %d behind\n", static_cast<int>(daemon));
  return give_up();
}

/// Accepts everything.
class Accomplice final : public dismantle::PathChecker {
 public:
  dismantle::PathCheck check(const dismantle::Path& path) const override {
    dismantle::PathCheck answer;
    answer.verified = accept(path, 0);
    return answer;
  }
};

/// Claims success with a path that goes nowhere, which a checker of its own accepted; the oracle must not believe it.
PathResult lie() {
  PathResult result;
  result.solve(*Accomplice().check({{dismantle::Pose{}}, {dismantle::Pose{}}}).verified, 1);
  return result;
}

}  // namespace

DISMANTLE_PLUGIN("evil.planners", "1.0.0", "MIT", "https://example.org/evil") {
  r.add<dismantle::PathPlanner, Planner<give_up>, NoParameters>("evil.none", "Gives up at once.",
                                                                {.source = "none", .needs = {}});
  r.add<dismantle::PathPlanner, Planner<abort_at_once>, NoParameters>("evil.abort", "Aborts.",
                                                                      {.source = "none", .needs = {}});
  r.add<dismantle::PathPlanner, Planner<spin>, NoParameters>("evil.spin", "Computes for ever.",
                                                             {.source = "none", .needs = {}});
  r.add<dismantle::PathPlanner, Planner<sleep_for_ever>, NoParameters>("evil.sleep", "Waits for ever.",
                                                                       {.source = "none", .needs = {}});
  r.add<dismantle::PathPlanner, Planner<eat_memory>, NoParameters>("evil.memory", "Eats memory.",
                                                                   {.source = "none", .needs = {}});
  r.add<dismantle::PathPlanner, Planner<scribble>, NoParameters>("evil.scribble", "Overwrites memory.",
                                                                 {.source = "none", .needs = {}});
  r.add<dismantle::PathPlanner, Planner<leave_a_daemon>, NoParameters>("evil.daemon", "Leaves a process behind.",
                                                                       {.source = "none", .needs = {}});
  r.add<dismantle::PathPlanner, Planner<lie>, NoParameters>("evil.lie", "Claims to be done.",
                                                            {.source = "none", .needs = {}});
}
