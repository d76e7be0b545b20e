// The hashed set of states against brute force.
#include "dismantle/path/state_set.h"

#include <gtest/gtest.h>

#include <numbers>

namespace dismantle::path {
namespace {

using Eigen::Vector3d;

State random_state(Rng& rng, std::size_t bodies, double spread, double turn) {
  State s;
  for (std::size_t i = 0; i < bodies; ++i) {
    const Vector3d t(rng.uniform(-spread, spread), rng.uniform(-spread, spread), rng.uniform(-spread, spread));
    const Vector3d w(rng.normal(), rng.normal(), rng.normal());
    BodyState b;
    b.pose = {t, rotation_from_vector(turn * w)};
    if (rng.below(2) == 0) b.pose.q.coeffs() *= -1;  // the same rotation
    s.bodies.push_back(b);
  }
  return s;
}

bool brute(const State& a, const State& b, const std::vector<Ball>& bodies, double translation, double rotation) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Pose &p = a.bodies[i].pose, &q = b.bodies[i].pose;
    if ((p * bodies[i].center - q * bodies[i].center).norm() >= translation) return false;
    const double dot = std::min(1.0, std::abs(p.q.dot(q.q)));
    if (2 * std::acos(dot) >= rotation) return false;
  }
  return true;
}

TEST(StateSet, AnswersLikeBruteForce) {
  Rng rng(41);
  for (int trial = 0; trial < 40; ++trial) {
    const std::size_t bodies = 1 + rng.below(3);
    std::vector<Ball> balls;
    for (std::size_t i = 0; i < bodies; ++i)
      balls.push_back({Vector3d(rng.normal(), rng.normal(), rng.normal()), rng.uniform(0, 1)});
    const double translation = rng.uniform(0.05, 0.5), rotation = rng.uniform(0.2, 3.1);
    const double spread = translation * rng.uniform(0.5, 3), turn = trial % 2 == 0 ? 0.0 : 0.3;
    StateSet set(balls, translation, rotation);
    std::vector<State> all;
    int found = 0;
    for (std::uint32_t n = 0; n < 120; ++n) {
      const State s = random_state(rng, bodies, spread, turn);
      bool expected = false, expected_others = false;
      const auto first = static_cast<std::uint32_t>(rng.below(n + 1)),
                 last = first + static_cast<std::uint32_t>(rng.below(30));
      for (std::uint32_t k = 0; k < n; ++k) {
        const bool close = brute(all[k], s, balls, translation, rotation);
        ASSERT_EQ(set.similar(all[k], s), close);
        expected |= close;
        expected_others |= close && !(k >= first && k < last);
      }
      ASSERT_EQ(set.has_similar(s), expected) << n;
      ASSERT_EQ(set.has_similar(s, first, last), expected_others) << n;
      found += expected ? 1 : 0;
      set.add(s, n);
      all.push_back(s);
      ASSERT_TRUE(set.has_similar(s));
      ASSERT_EQ(set.size(), n + 1);
    }
    EXPECT_LE(found, 120);
  }
}

TEST(StateSet, ThresholdsAreOpenAndTheWorldIsLarge) {
  const std::vector<Ball> ball{{Vector3d::Zero(), 1.0}};
  StateSet set(ball, 0.25, 0.5);
  const auto at = [](double x, double angle) {
    State s;
    s.bodies.resize(1);
    s.bodies[0].pose = {Vector3d(x, 0, 0), rotation_from_vector(Vector3d(0, 0, angle))};
    return s;
  };
  for (const double x : {0.0, -1e4, 1e4, 3e5}) {
    EXPECT_FALSE(set.has_similar(at(x, 0)));
    set.add(at(x, 0), 0);
    EXPECT_TRUE(set.has_similar(at(x + 0.2499, 0)));
    EXPECT_TRUE(set.has_similar(at(x - 0.2499, 0.4999)));
    EXPECT_FALSE(set.has_similar(at(x + 0.25, 0)));
    EXPECT_FALSE(set.has_similar(at(x, 0.5001)));
    EXPECT_FALSE(set.has_similar(at(x, std::numbers::pi)));
    EXPECT_TRUE(set.has_similar(at(x, 2 * std::numbers::pi - 0.1)));
  }
}

TEST(StateSet, OneBodyFarOffMakesAStateNew) {
  const std::vector<Ball> balls(2, Ball{});
  StateSet set(balls, 0.1, 0.1);
  State s;
  s.bodies.resize(2);
  set.add(s, 7);
  EXPECT_TRUE(set.has_similar(s));
  EXPECT_FALSE(set.has_similar(s, 7, 8)) << "its own run does not count";
  EXPECT_TRUE(set.has_similar(s, 7, 7)) << "an empty range ignores nothing";
  s.bodies[1].pose.t.x() = 0.2;
  EXPECT_FALSE(set.has_similar(s));
}

}  // namespace
}  // namespace dismantle::path
