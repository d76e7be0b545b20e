/// Laws of proposals: they rotate with the input.
#include "dismantle/push_search/actions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dismantle/run_context.h"
#include "dismantle/testing/shapes.h"

namespace dismantle::push {
namespace {

using Eigen::Vector3d;

Pose random_pose(Rng& rng) {
  const Vector3d w(rng.normal(), rng.normal(), rng.normal());
  return {Vector3d(rng.normal(), rng.normal(), rng.normal()), rotation_from_vector(2 * w)};
}

/// Two blocks, the first of which moves; in the frame `turned`.
Assembly blocks(Rng& rng, const Pose& turned) {
  Assembly a;
  for (PartId id = 0; id < 2; ++id) {
    const Vector3d lo(rng.uniform(-2, -1), rng.uniform(-2, -1), rng.uniform(-2, -1)), size(1.1, 2.3, 3.7);
    Mesh mesh = shapes::box(lo, lo + size);
    for (auto& v : mesh.vertices) v = turned * v;
    Part part;
    part.id = id;
    part.mesh = part.surface = std::make_shared<const Mesh>(std::move(mesh));
    a.parts.push_back(std::move(part));
  }
  return a;
}

const Scene kFirstMoves{.moving = {{0, Pose{}}}, .fixed = {{1, Pose{}}}};

TEST(OwnAxes, AreOrthonormalAndTurnWithTheParts) {
  Rng rng(1);
  for (int i = 0; i < 60; ++i) {
    const Pose turned = random_pose(rng);
    Rng as_given(static_cast<std::uint64_t>(i)), again = as_given;
    const Eigen::Matrix3d plain = own_axes(blocks(as_given, Pose{}), kFirstMoves, 0.035);
    const Eigen::Matrix3d axes = own_axes(blocks(again, turned), kFirstMoves, 0.035);
    EXPECT_LT((axes.transpose() * axes - Eigen::Matrix3d::Identity()).norm(), 1e-9);
    EXPECT_NEAR(axes.determinant(), 1, 1e-9);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(std::abs((turned.q * plain.col(k)).dot(axes.col(k))), 1, 1e-9);
    EXPECT_NEAR(std::abs(plain(0, 0)), 1, 1e-9) << "most of the surface faces along the shortest edge";
  }
}

TEST(Extents, TheWayOutIsTheSameHoweverTheAssemblyLies) {
  Rng rng(2);
  for (int i = 0; i < 60; ++i) {
    const Pose turned = random_pose(rng);
    Rng as_given(static_cast<std::uint64_t>(i)), again = as_given;
    const Assembly a = blocks(as_given, Pose{}), b = blocks(again, turned);
    const Extents plain(a, kFirstMoves, own_axes(a, kFirstMoves, 0.035)),
        there(b, kFirstMoves, own_axes(b, kFirstMoves, 0.035));
    for (int k = 0; k < 10; ++k) {
      const Vector3d d = Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
      EXPECT_NEAR(plain.exit_distance(d), there.exit_distance(turned.q * d), 1e-6);
    }
  }
}

/// Contacts with a few faces, in the frame `turned`.
std::vector<Contact> contacts_with_faces(Rng& rng, const Pose& turned) {
  std::vector<Contact> contacts;
  const int faces = 1 + static_cast<int>(rng.below(5));
  for (int f = 0; f < faces; ++f) {
    const Vector3d n = Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
    for (int k = 0; k < 3 + f; ++k) {
      Contact c;
      c.moving = 0;
      c.other = 1;
      c.point = turned * Vector3d(rng.normal(), rng.normal(), rng.normal());
      c.normal = turned.q * n;
      contacts.push_back(c);
    }
  }
  return contacts;
}

TEST(Freedom, TurnedContactsGiveTurnedDirectionsThatLeadIntoNone) {
  Rng rng(3);
  for (int i = 0; i < 200; ++i) {
    const Pose turned = random_pose(rng);
    const auto seed = static_cast<std::uint64_t>(i);
    Rng as_given(seed), again(seed), boxes(seed), boxes_again(seed);
    const Assembly a = blocks(boxes, Pose{}), b = blocks(boxes_again, turned);
    const Extents plain_extents(a, kFirstMoves, own_axes(a, kFirstMoves, 0.035));
    const Extents extents(b, kFirstMoves, own_axes(b, kFirstMoves, 0.035));
    const auto contacts = contacts_with_faces(again, turned);
    const Freedom plain = freedom_of(contacts_with_faces(as_given, Pose{}), kFirstMoves.moving, plain_extents, {});
    const Freedom freedom = freedom_of(contacts, kFirstMoves.moving, extents, {});
    ASSERT_EQ(plain.directions.size(), freedom.directions.size());
    for (std::size_t k = 0; k < plain.directions.size(); ++k) {
      EXPECT_LT((turned.q * plain.directions[k] - freedom.directions[k]).norm(), 1e-6) << "and in the same order";
      for (const Contact& c : contacts) EXPECT_GT(c.normal.dot(freedom.directions[k]), -0.0351);
    }
  }
}

}  // namespace
}  // namespace dismantle::push
