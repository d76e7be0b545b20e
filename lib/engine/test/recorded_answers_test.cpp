// Answers that are steps of the plan: what they list of the parts that stay does not add up.
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "dismantle/testing/oracle_rig.h"
#include "oracle.h"
#include "recorder.h"

namespace dismantle {
namespace {

using fake::Rig;

/// Takes the parts of a row out one after the other, and counts.
struct Recording {
  explicit Recording(unsigned parts) : rig(fake::row(parts), fake::setup(fake::push)) {}
  Oracle& oracle() { return static_cast<Oracle&>(*rig.oracle); }
  void take_out_all() {
    const Disassembly& now = recorder.disassembly();
    for (PartId id = 0; id + 1 < rig.assembly.parts.size(); ++id) {
      const std::vector<PartId> one{id};
      removals.push_back({one, &rig.ask({now.placed(one), now.around(id)})});
      recorder.removed(removals.back(), 0);
      most_kept = std::max(most_kept, oracle().kept());
    }
  }

  Rig rig;
  StepObserver nobody;
  Recorder recorder{rig.assembly, oracle(), rig.parts, rig.options, nobody, rig.context};
  std::vector<Removal> removals;
  std::size_t most_kept = 0;
};

TEST(RecordedAnswers, ListsOfFixedPartsDoNotAddUp) {
  constexpr unsigned kParts = 40;
  constexpr std::size_t kMost = 100;
  Recording r(kParts);
  r.oracle().keep_at_most(kMost);
  r.take_out_all();
  EXPECT_EQ(r.recorder.disassembly().steps().size(), kParts - 1);
  EXPECT_LE(r.most_kept, kMost);
  EXPECT_TRUE(r.removals.front().attempt->attempt.fixed.empty());
  std::size_t memory = 0;
  for (const Removal& removal : r.removals) memory += removal.attempt->attempt.fixed.capacity();
  EXPECT_LE(memory, kMost);
  EXPECT_EQ(r.removals.back().attempt->attempt.fixed.size(), 1u);
  for (const Removal& removal : r.removals) {  // all else is there
    EXPECT_EQ(removal.attempt->attempt.moving.size(), 1u);
    EXPECT_TRUE(removal.attempt->removes());
  }
}

TEST(RecordedAnswers, AreKeptWholeUpToTheLimit) {
  Recording r(40);
  r.take_out_all();
  EXPECT_EQ(r.oracle().kept(), 39u * 40 / 2);
  for (std::size_t k = 0; k < r.removals.size(); ++k) EXPECT_EQ(r.removals[k].attempt->attempt.fixed.size(), 39 - k);
}

TEST(RecordedAnswers, CanBeTakenBackAndRecordedAgain) {
  Recording r(10);
  r.oracle().keep_at_most(1);
  r.take_out_all();
  ASSERT_TRUE(r.recorder.taken_back(9));
  for (const Removal& removal : r.removals) r.recorder.removed(removal, 0);
  EXPECT_EQ(r.recorder.disassembly().steps().size(), 9u);
  EXPECT_EQ(r.recorder.problem(), "");
}

/// The second step with the first part still there: its question did not have it.
TEST(RecordedAnswers, WithoutTheirListAreStillForTheirQuestionOnly) {
  Recording r(10);
  r.oracle().keep_at_most(1);
  r.take_out_all();
  ASSERT_TRUE(r.removals[1].attempt->attempt.fixed.empty());
  ASSERT_TRUE(r.recorder.taken_back(9));
  EXPECT_THROW(r.recorder.removed(r.removals[1], 0), std::logic_error);
}

}  // namespace
}  // namespace dismantle
