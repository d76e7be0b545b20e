// One check that many threads ask at once. Run with the thread sanitizer, too.
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "dismantle/run_context.h"
#include "dismantle/testing/shapes.h"
#include "gravity.h"

namespace dismantle::checks {
namespace {

/// The operations that build a leaning pile of plates, one after the other.
struct Pile {
  explicit Pile(Rng& rng, std::size_t plates) {
    std::vector<Mesh> meshes;
    for (std::size_t k = 0; k < plates; ++k) {
      const double x = rng.uniform(-0.8, 0.8), y = rng.uniform(-0.8, 0.8), z = static_cast<double>(k);
      meshes.push_back(shapes::box({x - 1, y - 1, z}, {x + 1, y + 1, z + 1}));
    }
    assembly = shapes::assembly_of(meshes);
    for (PartId p = 0; p < plates; ++p) all.push_back({p, Pose{}});
    const std::span<const PlacedPart> parts(all);
    for (std::size_t k = 1; k < plates; ++k)
      questions.push_back({assembly, parts.subspan(k, 1), parts.first(k), -Eigen::Vector3d::UnitZ(), nullptr,
                           Eigen::Vector3d::UnitZ()});
  }
  Pile(const Pile&) = delete;
  Pile& operator=(const Pile&) = delete;

  Assembly assembly;
  std::vector<PlacedPart> all;
  std::vector<StepQuestion> questions;
};

TEST(GravityThreads, AskedByManyAtOnceItAnswersAsOneByOne) {
  Rng rng(17);
  std::size_t falls = 0, stands = 0;
  for (int round = 0; round < 6; ++round) {
    const Pile pile(rng, 6);
    const std::size_t count = pile.questions.size();
    std::vector<StepVerdict> alone;
    for (const StepQuestion& question : pile.questions) alone.push_back(Gravity().judge(question, RunContext{}));
    const Gravity shared;
    std::vector<std::vector<StepVerdict>> verdicts(4, std::vector<StepVerdict>(count));
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < verdicts.size(); ++t)
      threads.emplace_back([&, t] {
        for (std::size_t k = 0; k < count; ++k) {
          const std::size_t of = (k + t) % count;  // the same operations at about the same time
          verdicts[t][of] = shared.judge(pile.questions[of], RunContext{});
        }
      });
    for (std::thread& thread : threads) thread.join();
    for (std::size_t k = 0; k < count; ++k) {
      (alone[k].cost > 0 ? falls : stands) += 1;
      for (const auto& of_thread : verdicts) {
        EXPECT_EQ(of_thread[k].cost, alone[k].cost) << round << " " << k;
        ASSERT_EQ(of_thread[k].notes.size(), alone[k].notes.size()) << round << " " << k;
        for (std::size_t n = 0; n < alone[k].notes.size(); ++n) {
          EXPECT_EQ(of_thread[k].notes[n].text, alone[k].notes[n].text);
          EXPECT_EQ(of_thread[k].notes[n].data, alone[k].notes[n].data);
        }
        ASSERT_EQ(of_thread[k].certificate.has_value(), alone[k].certificate.has_value());
        if (alone[k].certificate) {
          EXPECT_EQ(of_thread[k].certificate->numbers, alone[k].certificate->numbers);
        }
      }
    }
  }
  EXPECT_GT(falls, 3u);
  EXPECT_GT(stands, 3u);
}

}  // namespace
}  // namespace dismantle::checks
