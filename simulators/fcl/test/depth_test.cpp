// Laws of collision and depth, against closed forms and against the verifier's measure.
#include <gtest/gtest.h>

#include <cmath>

#include "dismantle/preparation/prepare.h"
#include "dismantle/samples/samples.h"
#include "dismantle/testing/shapes.h"
#include "dismantle/verification/verifier.h"
#include "simulator.h"
#include "world.h"

namespace dismantle::mesh_collision {
namespace {

using Eigen::Vector3d;

std::shared_ptr<const Body> body_of(const Mesh& mesh, const std::vector<double>& depths) {
  Part part;
  part.name = "test";
  part.mesh = std::make_shared<Mesh>(mesh);
  return make_body(part, depths);
}

struct Pair {
  Pair(const Mesh& x, const Mesh& y) : a(body_of(x, {p.certified_depth})), b(body_of(y, {p.certified_depth})) {}
  double depth(const Pose& at, const Pose& to, double allowed = 0) { return check.depth(*a, at, *b, to, allowed); }
  double measured(const Pose& at, const Pose& to) { return check.measure(*a, at, *b, to, 1e9); }
  Parameters p;
  std::shared_ptr<const Body> a, b;
  PairCheck check{p};
};

/// A small box sunk into a large plate by d is d deep, at any pose of both.
TEST(FclDepth, BoxInPlate) {
  Rng rng(1);
  const Mesh box = shapes::box({-0.5, -0.4, 0}, {0.5, 0.4, 1}), plate = shapes::box({-5, -5, -1}, {5, 5, 0});
  Pair pair(box, plate);
  for (int i = 0; i < 300; ++i) {
    const Pose frame = shapes::random_pose(rng, 3);
    const double d = i % 2 == 0 ? rng.uniform(0, 0.006) : rng.uniform(0, 0.3);
    const Pose sunk = shapes::shift({rng.uniform(-4, 4), rng.uniform(-4, 4), -d});
    EXPECT_NEAR(pair.measured(frame * sunk, frame), d, pair.p.resolution + 1e-9);
    const double depth = pair.depth(frame * sunk, frame);
    EXPECT_GE(depth, d - pair.p.resolution - 1e-9);
    if (d < 0.5 * pair.p.certified_depth) {
      EXPECT_LE(depth, pair.p.certified_depth);
    } else if (d > pair.p.certified_depth && d < pair.p.depth_limit) {
      EXPECT_NEAR(depth, d, pair.p.resolution + 1e-9);
    }
  }
}

/// A sphere (its lowest vertex) sunk into a plate, either part the moving one.
TEST(FclDepth, SphereInPlate) {
  Rng rng(2);
  Mesh ball = shapes::sphere({0, 0, 0}, 1, 3);
  double lowest = 0;
  for (const auto& v : ball.vertices) lowest = std::min(lowest, v.z());
  const Mesh plate = shapes::box({-5, -5, -1}, {5, 5, 0});
  Pair pair(ball, plate), swapped(plate, ball);
  for (int i = 0; i < 100; ++i) {
    const Pose frame = shapes::random_pose(rng, 3);
    const double d = rng.uniform(0.0005, 0.3);
    const Pose sunk = shapes::shift({0, 0, -lowest - d});
    EXPECT_NEAR(pair.measured(frame * sunk, frame), d, pair.p.resolution + 1e-9);
    EXPECT_NEAR(swapped.measured(frame, frame * sunk), d, pair.p.resolution + 1e-9);
    EXPECT_GE(pair.depth(frame * sunk, frame), d - pair.p.resolution - 1e-9);
    EXPECT_DOUBLE_EQ(pair.depth(frame * shapes::shift({0, 0, -lowest + 1e-6 + d}), frame), 0);
  }
}

/// A part wholly inside another collides although no surfaces meet; a part inside a void does not.
TEST(FclDepth, Containment) {
  const Mesh outer = shapes::box({-2, -2, -2}, {2, 2, 2}), inner = shapes::box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
  Pair pair(inner, outer), swapped(outer, inner);
  const Pose off = shapes::shift({0.3, -0.2, 0.1});
  EXPECT_TRUE(pair.check.collide(*pair.a, off, *pair.b, {}));
  EXPECT_TRUE(swapped.check.collide(*swapped.a, {}, *swapped.b, off));
  EXPECT_NEAR(pair.measured(off, {}), 1.5, 0.31);  // deepest corner: at least 1.2
  EXPECT_GE(pair.depth(off, {}), 1.2);             // beyond the limit: an upper bound
  EXPECT_GE(swapped.depth({}, off), 1.2);
  Pair hollow(inner, shapes::closed_box({-2, -2, -2}, {2, 2, 2}, 0.1));
  EXPECT_FALSE(hollow.check.collide(*hollow.a, off, *hollow.b, {}));
  EXPECT_EQ(hollow.depth(off, {}), 0);
}

/// Faces that touch, or sink in by rounding, are no obstacle; nor is the assembled overlap of a pair, for that pair.
TEST(FclDepth, FlushAndOverlap) {
  Rng rng(3);
  const Mesh block = shapes::box({-2, -2, 0}, {2, 2, 1}), base = shapes::box({-3, -3, -1}, {3, 3, 0});
  Pair pair(block, base);
  for (int i = 0; i < 50; ++i) {
    const Pose frame = shapes::random_pose(rng, 3);
    const Pose slid = shapes::shift({rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1e-6, 1e-6)});
    EXPECT_LE(pair.depth(frame * slid, frame), pair.p.certified_depth);
  }
  const Pose sunk = shapes::shift({0, 0, -0.003});
  EXPECT_NEAR(pair.depth(sunk, {}, 0.0), 0.003, pair.p.resolution);
  EXPECT_LE(pair.depth(sunk, {}, 0.003), pair.p.certified_depth);
}

Mesh part_of(const char* sample, const char* name) {
  RunContext context;
  PrepareReport report;
  const Assembly assembly = prepare_assembly(samples::make(sample), sample, "", {}, context, report);
  for (const auto& part : assembly.parts)
    if (part.name == name) return *part.mesh;
  throw std::runtime_error(name);
}

/// Against the verifier's own measure, on slightly displaced real shapes: a measured depth never exceeds the true
/// depth, and a reported depth is never below it.
TEST(FclDepth, SoundAgainstTheJudge) {
  constexpr double kTolerance = 2e-4;
  Rng rng(4);
  struct Case {
    const char *sample, *a, *b;
  };
  int colliding = 0, certified = 0;
  for (const Case c : {Case{"peg_in_hole", "peg", "block"}, Case{"l_slot", "slider", "housing"},
                       Case{"stacked_box", "plate_2", "box"}}) {
    const Mesh a = part_of(c.sample, c.a), b = part_of(c.sample, c.b);
    Pair pair(a, b);
    const Vector3d center = pair.a->center;
    for (int i = 0; i < 40; ++i) {
      Pose pose;
      pose.q = rotation_from_vector(shapes::random_vector(rng, -0.004, 0.004));
      pose.t = center - pose.q * center + shapes::random_vector(rng, -0.05, 0.05);
      const double truth = penetration_depth(a, pose, b, {}, kTolerance);  // from below
      const double depth = pair.depth(pose, {});
      EXPECT_LE(pair.measured(pose, {}), truth + kTolerance) << c.sample << i;
      EXPECT_GE(depth, truth - pair.p.resolution - 1e-9) << c.sample << i;
      if (truth < pair.p.depth_limit - pair.p.resolution) {
        EXPECT_LE(depth, std::max(truth + kTolerance, pair.p.certified_depth)) << c.sample << i;
      }
      colliding += truth > 0;
      certified += depth > 0 && depth == pair.p.certified_depth;
    }
  }
  EXPECT_GT(colliding, 40);
  EXPECT_GT(certified, 0);
}

/// A shrunken copy lies inside the original and within its depth of it.
TEST(FclDepth, Insets) {
  for (const Mesh& mesh : {part_of("peg_in_hole", "block"), part_of("bolt_and_nut", "bolt"),
                           part_of("l_slot", "housing"), shapes::closed_box({-2, -2, -2}, {2, 2, 2}, 0.004)}) {
    const auto body = body_of(mesh, {});
    for (const double depth : {0.002, 0.02}) {
      const auto displacement = inset_displacements(mesh, body->solids, depth);
      std::size_t moved = 0;
      for (std::size_t v = 0; v < displacement.size(); ++v) {
        ASSERT_LE(displacement[v].norm(), depth * (1 + 1e-12));
        if (displacement[v].norm() == 0) continue;
        ++moved;
        EXPECT_LT(signed_distance(body->solids, mesh.vertices[v] + displacement[v]), 1e-12);
      }
      EXPECT_GT(moved, displacement.size() * 9 / 10);
    }
  }
}

/// A wall thinner than the depth step also stops a shrunken copy.
TEST(FclDepth, ThinWallIsNoHole) {
  Pair pair(shapes::box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}), shapes::box({-3, -3, 0}, {3, 3, 0.003}));
  for (double z = -0.49; z < 0.49; z += 0.01) EXPECT_GT(pair.depth(shapes::shift({0.1, 0.2, z}), {}), 0.0007) << z;
}

class FclWorld : public ::testing::Test {
 protected:
  std::unique_ptr<World> world(const Scene& scene) {
    prepared = simulator.prepare(assembly, 0.01, context);
    return simulator.world(assembly, *prepared, scene, MotionSpace::rigid);
  }
  static State at(const std::vector<Pose>& poses) {
    State s;
    for (const auto& p : poses) s.bodies.push_back({p, Vector3d::Zero(), Vector3d::Zero()});
    return s;
  }
  Parameters parameters;
  FclSimulator simulator{parameters};
  RunContext context;
  Assembly assembly = shapes::assembly_of(
      {shapes::box({0, 0, 0}, {1, 1, 1}), shapes::box({2, 0, 0}, {3, 1, 1}), shapes::box({-5, -5, -1}, {5, 5, 0})});
  std::shared_ptr<const PreparedAssembly> prepared;
};

TEST_F(FclWorld, OffersGeometryOnly) {
  EXPECT_FALSE(simulator.capabilities().dynamics);
  EXPECT_FALSE(simulator.capabilities().contacts);
  EXPECT_TRUE(simulator.capabilities().distance);
  EXPECT_GE(simulator.capabilities().max_moving, 2u);
  const auto w = world({{{0, {}}}, {{2, {}}}});
  State s = w->initial_state();
  std::vector<Contact> contacts;
  EXPECT_THROW(w->advance(s, {{{}}}, 0.1), std::logic_error);
  EXPECT_THROW(w->contacts(s, contacts), std::logic_error);
}

TEST_F(FclWorld, MovingPartsMeetEachOther) {
  const auto w = world({{{0, {}}, {1, {}}}, {{2, {}}}});
  const Pose up = shapes::shift({0, 0, 0.5});
  EXPECT_EQ(w->penetration(at({up, up})), 0);
  EXPECT_NEAR(w->penetration(at({shapes::shift({1.004, 0, 0.5}), up})), 0.004, parameters.resolution);
  EXPECT_GT(w->penetration(at({shapes::shift({1.5, 0, 0.5}), up})), 0.49);
  EXPECT_GT(w->penetration(at({up, shapes::shift({0, 0, -0.5})})), 0.49);
}

TEST_F(FclWorld, SeparatedMeansHullsApart) {
  const auto w = world({{{0, {}}}, {{1, {}}, {2, {}}}});
  EXPECT_FALSE(w->separated(at({shapes::shift({0, 0, 0.5})})));  // above the plate, beside a block on it
  EXPECT_TRUE(w->separated(at({shapes::shift({0, 0, 1.1})})));
  EXPECT_TRUE(w->separated(at({shapes::shift({0, 9, 0})})));
}

TEST_F(FclWorld, AnswersDependOnTheStateAlone) {
  Rng rng(5);
  const auto w = world({{{0, {}}}, {{1, {}}, {2, {}}}});
  std::vector<State> states;
  std::vector<double> first;
  for (int i = 0; i < 50; ++i) states.push_back(at({shapes::shift(shapes::random_vector(rng, -0.01, 2))}));
  for (const auto& s : states) first.push_back(w->penetration(s));
  for (std::size_t i = states.size(); i-- > 0;) EXPECT_EQ(w->penetration(states[i]), first[i]);
}

/// Equal parts share one hierarchy, at any pose.
TEST_F(FclWorld, EqualPartsShare) {
  prepared = simulator.prepare(assembly, 0.01, context);
  const auto& bodies = dynamic_cast<const PreparedBodies&>(*prepared);
  EXPECT_EQ(bodies.placed[0].body, bodies.placed[1].body);
  EXPECT_NE(bodies.placed[0].body, bodies.placed[2].body);
}

}  // namespace
}  // namespace dismantle::mesh_collision
