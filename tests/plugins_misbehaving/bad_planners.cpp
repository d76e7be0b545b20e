// Planners and an importer that misbehave, each in its own way.
#include <unistd.h>

#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <vector>

#include "dismantle/errors.h"
#include "dismantle/executor.h"
#include "dismantle/plugin.h"

namespace {

using dismantle::Outcome;
using dismantle::Path;
using dismantle::PathQuery;
using dismantle::PathResult;
using dismantle::Pose;
using dismantle::RunContext;

using Do = PathResult (*)(const PathQuery&, RunContext&);

template <Do kDo>
class Planner final : public dismantle::FunctionPathPlanner {
 public:
  dismantle::PathPlannerTraits traits() const noexcept override { return {}; }
  PathResult plan(const PathQuery& query, RunContext& context) override { return kDo(query, context); }
};

/// `Thrown` is thrown where the object is made.
template <class Thrown>
class Unmade final : public dismantle::FunctionPathPlanner {
 public:
  Unmade() {
    if constexpr (std::is_same_v<Thrown, int>)
      throw 7;
    else
      throw Thrown("no licence for today");
  }
  dismantle::PathPlannerTraits traits() const noexcept override { return {}; }
  PathResult plan(const PathQuery&, RunContext&) override { return {}; }
};

/// Accepts everything.
class Accomplice final : public dismantle::PathChecker {
 public:
  dismantle::PathCheck check(const Path& path) const override {
    dismantle::PathCheck answer;
    answer.verified = accept(path, 0);
    return answer;
  }
};

PathResult claim(const Path& path) {
  PathResult result;
  result.solve(*Accomplice().check(path).verified, 1);
  return result;
}

Path up(const PathQuery& query, double height) {
  Path path(2);
  for (const auto& moving : query.scene.moving) {
    path[0].push_back(moving.pose);
    path[1].push_back(moving.pose);
    path[1].back().t.z() += height;
  }
  return path;
}

PathResult honest(const PathQuery& query, RunContext&) {
  const auto check = query.checker.check(up(query, 50));
  PathResult result = PathResult::failure(Outcome::exhausted, "not upwards");
  if (check.accepted()) result.solve(*check.verified, 1);
  return result;
}

PathResult throws(const PathQuery&, RunContext&) { throw std::out_of_range("index 7 of 3"); }
PathResult throws_int(const PathQuery&, RunContext&) { throw 7; }

PathResult not_finite(const PathQuery& query, RunContext&) {
  return claim(up(query, std::numeric_limits<double>::quiet_NaN()));
}

PathResult jump(const PathQuery& query, RunContext&) {  // down, through the floor
  return claim(up(query, -50));
}

PathResult wrong_parts(const PathQuery& query, RunContext&) {
  Path path = up(query, 50);
  for (auto& instant : path) instant.emplace_back();
  return claim(path);
}

/// Works while more than two parts are fixed, then reads where nothing is.
PathResult segfault(const PathQuery& query, RunContext& context) {
  if (query.scene.fixed.size() > 2) return honest(query, context);
  const volatile int* volatile nowhere = nullptr;
  return PathResult::failure(*nowhere != 0 ? Outcome::exhausted : Outcome::timeout);
}

PathResult abort_later(const PathQuery& query, RunContext& context) {
  if (query.scene.fixed.size() > 2) return honest(query, context);
  std::abort();
}

/// Uses up the stack of its thread.
unsigned descend(unsigned levels) {
  if (levels == 0) return 0;
  volatile char room[4096] = {};
  room[levels % sizeof room] = 1;
  return descend(levels - 1) + static_cast<unsigned>(room[0]);
}
constexpr unsigned kTooDeep = 10'000'000;

/// On a thread of the executor where there is one.
PathResult overflow(const PathQuery& query, RunContext& context) {
  if (query.scene.fixed.size() > 2) return honest(query, context);
  if (!context.executor) return PathResult::failure(descend(kTooDeep) == 0 ? Outcome::exhausted : Outcome::timeout);
  unsigned sum = 0;
  auto task = context.executor->submit([&] { sum = descend(kTooDeep); }, dismantle::Executor::Priority::fork_join);
  task.wait();
  return PathResult::failure(sum == 0 ? Outcome::exhausted : Outcome::timeout);
}

PathResult hang(const PathQuery& query, RunContext& context) {
  if (query.scene.fixed.size() > 2) return honest(query, context);
  static const char words[] = "bad.hang hangs\n";  // the test waits for it
  if (::write(STDERR_FILENO, words, sizeof words - 1) < 0) return {};
  for (;;) ::pause();
}

PathResult eat_memory(const PathQuery& query, RunContext& context) {
  if (query.scene.fixed.size() > 2) return honest(query, context);
  std::vector<std::vector<char>> eaten;
  for (;;) eaten.emplace_back(std::size_t{16} << 20, 'x');
}

/// Sequence planners.
enum class Fault { throws, claims_success, removes_twice, segfault };

template <Fault kFault>
class Sequence final : public dismantle::SequencePlanner {
 public:
  dismantle::SequenceResult plan(const dismantle::SequenceQuery& query, dismantle::PathOracle& oracle,
                                 dismantle::SequenceObserver& observer, RunContext& context) override {
    const dismantle::Assembly& assembly = query.assembly;
    dismantle::SequenceResult result;
    dismantle::Attempt attempt;
    for (const auto& part : assembly.parts) {
      const bool lid = part.name == "lid";  // of the sample stacked_box: it leaves first
      (lid ? attempt.moving : attempt.fixed).push_back({part.id, Pose{}});
    }
    const auto& answer = oracle.attempt(attempt, context);
    result.removals.push_back({{attempt.moving.at(0).part}, &answer});
    observer.removed(result.removals.back(), assembly.parts.size() - 1);
    if (kFault == Fault::throws) throw std::runtime_error("out of ideas");
    if (kFault == Fault::removes_twice) observer.removed(result.removals.back(), assembly.parts.size() - 1);
    volatile int* volatile nowhere = nullptr;
    if (kFault == Fault::segfault) *nowhere = 1;
    result.outcome = Outcome::solved;
    return result;
  }
};

class Importer final : public dismantle::Importer {
 public:
  std::vector<std::string> extensions() const override { return {"crash"}; }
  std::vector<dismantle::RawPart> read(const std::filesystem::path&, const RunContext&) override { std::abort(); }
};

}  // namespace

DISMANTLE_PLUGIN("bad.planners", "1.0.0", "MIT", "https://example.org/bad") {
  using dismantle::PathPlanner;
  using dismantle::SequencePlanner;
  r.add<PathPlanner, Unmade<std::runtime_error>>("bad.factory", "Cannot be made.");
  r.add<PathPlanner, Unmade<int>>("bad.factory_int", "Cannot be made, and does not say why.");
  r.add<PathPlanner, Planner<honest>>("bad.honest", "Upwards; the only good one here.");
  r.add<PathPlanner, Planner<throws>>("bad.throws", "Throws.");
  r.add<PathPlanner, Planner<throws_int>>("bad.throws_int", "Throws a number.");
  r.add<PathPlanner, Planner<not_finite>>("bad.not_finite", "Claims a path that is not a number.");
  r.add<PathPlanner, Planner<jump>>("bad.jump", "Claims a path through the floor.");
  r.add<PathPlanner, Planner<wrong_parts>>("bad.wrong_parts", "Claims a path of more parts than move.");
  r.add<PathPlanner, Planner<segfault>>("bad.segfault", "Crashes at the third-last part.");
  r.add<PathPlanner, Planner<abort_later>>("bad.abort", "Aborts at the third-last part.");
  r.add<PathPlanner, Planner<overflow>>("bad.overflow", "Uses up its stack at the third-last part.");
  r.add<PathPlanner, Planner<hang>>("bad.hang", "Hangs at the third-last part.");
  r.add<PathPlanner, Planner<eat_memory>>("bad.memory", "Eats memory at the third-last part.");
  r.add<SequencePlanner, Sequence<Fault::throws>>("bad.sequence_throws", "Throws after one part.");
  r.add<SequencePlanner, Sequence<Fault::claims_success>>("bad.sequence_claims", "Claims to be done after one part.");
  r.add<SequencePlanner, Sequence<Fault::removes_twice>>("bad.sequence_twice", "Removes a part twice.");
  r.add<SequencePlanner, Sequence<Fault::segfault>>("bad.sequence_segfault", "Crashes after one part.");
  r.add<dismantle::Importer, Importer>("bad.importer", "Aborts.");
}
