// Cached data of StraightMotion does not change its answers.
#include "blocking_graph/straight_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/testing/fake_planning.h"

namespace dismantle::blocking {
namespace {

/// Accepts every path that is proposed.
class AcceptingOracle final : public PathOracle {
 public:
  const AttemptResult& attempt(const Attempt&, RunContext&) override { throw std::logic_error("not to be asked"); }
  void prefetch(std::span<const Attempt>, RunContext&) override {}
  const AttemptResult& propose(const Attempt& attempt, const Path& path, RunContext&) override {
    AttemptResult& answer = answers_.emplace_back();
    answer.attempt = attempt;
    answer.result.solve(*checker_.check(path).verified, 1);
    return answer;
  }
  OracleCounts counts() const override { return {}; }
  double tolerance() const override { return 0.01; }

 private:
  class Checker final : public PathChecker {
   public:
    PathCheck check(const Path& path) const override {
      PathCheck answer;
      answer.verified = accept(path, 0);
      return answer;
    }
  };
  Checker checker_;
  std::deque<AttemptResult> answers_;
};

class Observer final : public SequenceObserver {
  void removed(const Removal&, std::size_t) override {}
};

/// Boxes of any size, in and out of reach of each other.
Assembly any_boxes(Rng& rng) {
  std::vector<std::pair<std::string, std::vector<fake::Box>>> parts;
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector3d lo(rng.uniform(0, 20), rng.uniform(0, 20), rng.uniform(0, 20));
    const Eigen::Vector3d size(rng.uniform(0.5, 4), rng.uniform(0.5, 4), rng.uniform(0.5, 4));
    parts.push_back({"box_" + std::to_string(k), {{lo, lo + size}}});
  }
  return fake::assembly_of(parts);
}

/// The disassembly of random boxes by an oracle that accepts everything.
struct Boxes {
  explicit Boxes(Rng& rng) : assembly(any_boxes(rng)) {}
  const Assembly assembly;
  AcceptingOracle oracle{};
  Observer observer{};
  const Constraints constraints{};
  RunContext context{};
  const Objective objective{};
  const SequenceQuery query{assembly, whole_assembly(assembly), constraints, objective};
  DisassemblyState state{query, {}, PartOrder::as_given, observer, context};
  const PairSweep sweep{assembly, oracle};
};

/// Parts leave alone or as groups, or are translated within their group. Every group of the run is asked about.
TEST(StraightMotion, DirectionsAreThoseOfOneThatKnowsNothing) {
  Rng rng(8);
  for (int trial = 0; trial < 20; ++trial) {
    Boxes boxes(rng);
    const Assembly& assembly = boxes.assembly;
    DisassemblyState& state = boxes.state;
    StraightMotion kept(state, boxes.oracle, boxes.sweep, directions_of(assembly));
    state.add_listener(kept);
    while (!state.waiting().empty()) {
      GroupState group = state.waiting().front();
      state.waiting().pop_front();
      while (group.members.size() > 1) {
        StraightMotion fresh(state, boxes.oracle, boxes.sweep, directions_of(assembly));
        for (std::uint64_t asked = rng.below(2 * group.members.size()); asked > 0; --asked) {
          const SubassemblyId id = group.members[rng.below(group.members.size())];
          ASSERT_EQ(kept.directions_of(group, id), fresh.directions_of(group, id)) << trial;
          ASSERT_EQ(kept.length_out(group, {id}, 0), fresh.length_out(group, {id}, 0)) << trial;
        }
        Subassemblies ids{group.members[rng.below(group.members.size())]};
        if (const SubassemblyId other = group.members[rng.below(group.members.size())];
            other != ids[0] && group.members.size() > 2)
          ids = {std::min(ids[0], other), std::max(ids[0], other)};
        const bool stays = rng.below(3) == 0;
        Attempt attempt = state.attempt_for(group, ids);
        attempt.goal.placement = stays;
        Path path(2);
        const Eigen::Vector3d shift(rng.uniform(-9, 9), rng.uniform(-9, 9), rng.uniform(-9, 9));
        for (const PlacedPart& p : attempt.moving) {
          path[0].push_back(p.pose);
          path[1].push_back({p.pose.t + shift, p.pose.q});
        }
        state.commit(group, ids, attempt, boxes.oracle.propose(attempt, path, boxes.context),
                     stays ? GroupChange::Kind::translated : GroupChange::Kind::removed);
      }
    }
  }
}

/// What the filter leaves out is far by Relations::far(), whatever has moved since; and it leaves most of that out.
TEST(UnitExtents, LeaveOutOnlyWhatIsFar) {
  Rng rng(9);
  std::size_t far = 0, left_in = 0, near = 0;
  for (int trial = 0; trial < 20; ++trial) {
    Boxes boxes(rng);
    const Assembly& assembly = boxes.assembly;
    DisassemblyState& state = boxes.state;
    const Directions directions = directions_of(assembly);
    const Relations relations(boxes.sweep, directions, state.orientations(), nullptr);
    UnitExtents extents(state, relations, directions.all.size());
    const Subassemblies all = state.waiting().front().members;
    for (int move = 0; move < 6; ++move) {
      for (const SubassemblyId a : all)
        for (std::size_t d = 0; d < directions.all.size(); ++d) {
          const Subassemblies found = extents.near(all, a, d);
          std::vector<bool> is_found(all.size(), false);
          for (const SubassemblyId b : found) is_found[b] = true;
          EXPECT_TRUE(std::is_sorted(found.begin(), found.end()) && !is_found[a]);
          for (const SubassemblyId b : all) {
            if (a == b) continue;
            const PartId p = state.part_of(a), q = state.part_of(b);
            const Pair pair{p, q, d, state.pose(p).t - state.pose(q).t, state.orientation(p), state.orientation(q)};
            const bool is_far = relations.far(pair);
            EXPECT_TRUE(is_far || is_found[b]) << trial << " " << move;
            (is_far ? far : near)++;
            left_in += is_far && is_found[b] ? 1 : 0;
          }
        }
      const SubassemblyId moved = all[rng.below(all.size())];
      const Eigen::Vector3d axis = Eigen::Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), 1).normalized();
      state.set_pose(state.part_of(moved),
                     {{rng.uniform(-9, 9), rng.uniform(-9, 9), rng.uniform(-9, 9)},
                      Eigen::Quaterniond(Eigen::AngleAxisd(rng.below(2) == 0 ? 0 : rng.uniform(0, 6), axis))});
      if (move % 2 == 0) extents.moved({moved});  // otherwise it finds out by itself
    }
  }
  EXPECT_GT(near, 500u);
  EXPECT_GT(far, 1000u);
  EXPECT_LT(left_in, far / 1000);
}

}  // namespace
}  // namespace dismantle::blocking
