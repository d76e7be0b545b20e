// Small random scenes against sampled placements, which FCL tests on the triangles.
#include <fcl/fcl.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>

#include "dismantle/testing/trials.h"
#include "frame.h"
#include "scene.h"

namespace dismantle::tools {
namespace {

using namespace test;
using std::numbers::pi;
using Model = fcl::BVHModel<fcl::OBBd>;

Mesh block(Rng& rng, double near, double far, double top) {
  Mesh mesh = rng.below(3) == 0 ? shapes::tube(rng.uniform() < 0.5 ? 0 : 3, rng.uniform(4, 9), -6, 6, 11)
                                : shapes::box({0, 0, 0}, shapes::random_vector(rng, 2, 25));
  const double angle = rng.uniform(0, 2 * pi), r = rng.uniform(near, far);
  Pose pose = shapes::random_pose(rng, 0);
  pose.t = {r * std::cos(angle), r * std::sin(angle), rng.uniform(-5, top)};
  return shapes::moved(mesh, pose);
}

/// A key of one or two arms, a driver, or a tool with a rounded end; sometimes with a hand.
Tool random_tool(Rng& rng) {
  Tool tool;
  Use& use = tool.uses.emplace_back();
  const double height = rng.uniform(10, 25), length = rng.uniform(20, 60), wide = rng.uniform(1, 4);
  use.swing = rng.uniform() < 0.3 ? 0 : rng.uniform(0.1, 1.5);
  use.depth = rng.uniform(0, 4);
  use.tool = {tube(wide, 0, height), box({0, -wide}, {length, wide}, height - 2 * wide, height)};
  if (rng.below(2) == 0) use.tool.push_back(box({-length / 2, -wide / 2}, {0, wide}, height - wide, height));
  use.hand = {obround({length - 5, 0}, {length + 5, 0}, 6, height - 8, height + 8)};
  return tool;
}

struct Bodies {
  std::vector<std::pair<std::shared_ptr<fcl::CollisionGeometryd>, Eigen::Vector3d>> shapes;  // middle

  explicit Bodies(const std::vector<Volume>& volumes) {
    for (const Volume& v : volumes) {
      const double high = v.high - v.low, z = (v.low + v.high) / 2;
      const auto cylinder = [&](const Eigen::Vector2d& at) {
        shapes.emplace_back(std::make_shared<fcl::Cylinderd>(v.radius, high), Eigen::Vector3d(at.x(), at.y(), z));
      };
      const Eigen::Vector2d middle = (v.from + v.to) / 2, size = v.to - v.from;
      if (v.form == Form::tube) cylinder({0, 0});
      if (v.form == Form::box)
        shapes.emplace_back(std::make_shared<fcl::Boxd>(size.x(), size.y(), high),
                            Eigen::Vector3d(middle.x(), middle.y(), z));
      if (v.form == Form::obround) {  // along x in these tests
        cylinder(v.from);
        cylinder(v.to);
        shapes.emplace_back(std::make_shared<fcl::Boxd>(size.x(), 2 * v.radius, high),
                            Eigen::Vector3d(middle.x(), middle.y(), z));
      }
    }
  }
};

/// Sampled placements. What a sample met is kept, and is asked again first where the next sample begins beside it: most
/// samples are refused by one triangle.
class Brute {
 public:
  Brute(const std::vector<Mesh>& parts, const Use& use, const Fastener& fastener)
      : frame_(use, fastener), resting_(use.tool), met_(720) {
    std::vector<Volume> resting = use.tool;
    resting.insert(resting.end(), use.hand.begin(), use.hand.end());
    resting_ = Bodies(resting);
    lift_ = fastener.travel + use.depth;
    double lowest = lift_;
    for (const Volume& v : resting) lowest = std::min(lowest, v.high - v.low);
    heights_ = lift_ > 0 ? static_cast<int>(std::ceil(lift_ / lowest)) : 0;
    for (const Mesh& part : parts)
      for (std::size_t t = 0; t < part.triangles.size(); ++t)
        triangles_.push_back({part.vertex(t, 0), part.vertex(t, 1), part.vertex(t, 2)});
    model_ = model_of(triangles_);
  }
  /// The tool at an angle and a height above its seat.
  bool free(double angle, double height) const { return !meets(angle, height, *model_); }
  /// The whole travel, in samples. Upright prisms that are moved up by no more than their height leave nothing out.
  bool free_swing(double start, double swing, int samples) const {
    std::vector<Met>& near = met_[bucket(start)];
    for (const Met& met : near)
      if (meets(start + met.turned, met.height, *met.triangle, met.body)) return false;
    const int turns = swing > 0 ? samples : 0;
    for (int k = 0; k <= turns; ++k)
      for (int h = 0; h <= heights_; ++h) {
        const double turned = turns > 0 ? swing * k / turns : 0, height = heights_ > 0 ? lift_ * h / heights_ : 0;
        const auto met = meets(start + turned, height, *model_);
        if (!met) continue;
        if (near.size() == 4) near.erase(near.begin());
        near.push_back({turned, height, met->body, model_of({triangles_.at(met->triangle)})});
        return false;
      }
    return true;
  }

 private:
  using Triangle = std::array<Vec3, 3>;
  struct Met {
    double turned, height;
    std::size_t body;
    std::shared_ptr<Model> triangle;
  };
  struct Place {
    std::size_t body, triangle;
  };

  static std::shared_ptr<Model> model_of(const std::vector<Triangle>& triangles) {
    auto model = std::make_shared<Model>();
    model->beginModel();
    for (const Triangle& t : triangles) model->addTriangle(t[0], t[1], t[2]);
    model->endModel();
    return model;
  }
  std::size_t bucket(double angle) const {
    const double share = angle / (2 * pi);
    return std::min(met_.size() - 1, static_cast<std::size_t>((share - std::floor(share)) * double(met_.size())));
  }
  bool meets(double angle, double height, const Model& model, std::size_t body, std::size_t* triangle = nullptr) const {
    const Eigen::Matrix3d turn = frame_.axes * Eigen::AngleAxisd(angle, Vec3::UnitZ());
    const auto& [shape, middle] = resting_.shapes[body];
    fcl::Transform3d at = fcl::Transform3d::Identity();
    at.linear() = turn;
    at.translation() = frame_.origin + turn * (middle + height * Vec3::UnitZ());
    fcl::CollisionResultd result;
    const fcl::CollisionRequestd request;
    if (fcl::collide(&model, fcl::Transform3d::Identity(), shape.get(), at, request, result) == 0) return false;
    if (triangle != nullptr) *triangle = static_cast<std::size_t>(result.getContact(0).b1);
    return true;
  }
  std::optional<Place> meets(double angle, double height, const Model& model) const {
    Place place{};
    for (; place.body < resting_.shapes.size(); ++place.body)
      if (meets(angle, height, model, place.body, &place.triangle)) return place;
    return std::nullopt;
  }

  Frame frame_;
  Bodies resting_;
  double lift_ = 0;
  int heights_ = 0;
  std::vector<Triangle> triangles_;
  std::shared_ptr<Model> model_;
  mutable std::vector<std::vector<Met>> met_;  // by the angle at which the swing begins
};

/// Laws: a placement that is reported meets nothing anywhere on its travel; where none is, every sampled one meets
/// something. Neither answer is rare, and some placements have little room.
TEST(FindAccess, AgreesWithSampledPlacements) {
  Rng rng(55);
  int reached = 0, blocked = 0, narrow = 0;
  for (int round = 0; round < testing_support::trials(120, 2000); ++round) {
    std::vector<Mesh> parts;
    for (auto n = 2 + rng.below(14); n > 0; --n) parts.push_back(block(rng, 14, 60, 30));
    const Tool tool = random_tool(rng);
    Fastener fastener = m3();
    fastener.travel = rng.uniform(0, 6);
    fastener.axis = shapes::random_pose(rng, 0).q * Vec3::UnitZ();
    const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), fastener.axis);
    for (Mesh& part : parts) part = shapes::moved(part, {Vec3::Zero(), turn});
    const Scene scene(parts, fastener);
    const Use& use = tool.uses.front();
    const Brute brute(parts, use, fastener);
    const Access access = scene.find(tool);
    if (access.reaches()) {
      ++reached;
      EXPECT_TRUE(brute.free_swing(access.start, use.swing, 12)) << "round " << round;
      continue;
    }
    ++blocked;
    ASSERT_FALSE(access.obstacles.empty());
    for (int k = 0; k < testing_support::trials(60, 400); ++k)
      EXPECT_FALSE(brute.free_swing(rng.uniform(0, 2 * pi), use.swing, 24)) << "round " << round;
    // Without the parts that are in the way it has room, and they are the fewest.
    std::vector<Obstacle> left;
    std::vector<Mesh> kept;
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (std::find(access.obstacles.begin(), access.obstacles.end(), i) == access.obstacles.end())
        left.push_back(scene.obstacles()[i]), kept.push_back(parts[i]);
    const Access room = find_access(tool, fastener, left);
    ASSERT_TRUE(room.reaches()) << "round " << round;
    EXPECT_TRUE(Brute(kept, use, fastener).free_swing(room.start, use.swing, 12)) << "round " << round;
    narrow += access.obstacles.size() > 1;
    for (std::size_t without = 0; access.obstacles.size() > 1 && without < parts.size(); ++without) {
      std::vector<Obstacle> others = scene.obstacles();
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(without));
      EXPECT_FALSE(find_access(tool, fastener, others).reaches()) << "round " << round << " part " << without;
    }
  }
  EXPECT_GE(reached, 30);
  EXPECT_GE(blocked, 30);
  EXPECT_GE(narrow, 5);
}

/// A scene in which the tool has room for its swing and `spare` more, and nowhere else: posts stand around it. Blocks
/// beyond them, above and below are kept where the tool in its place does not meet them. The axis is z.
std::vector<Mesh> narrow_scene(Rng& rng, const Use& use, const Fastener& fastener, double spare) {
  const double radius = 0.8 * use.tool[1].to.x(), from = rng.uniform(0, 2 * pi);
  const Eigen::Matrix3d axes = Frame(use, fastener).axes;
  const auto post = [&](double angle) {
    Mesh mesh = shapes::tube(0, 1, -10, 60, 48);
    for (Vec3& p : mesh.vertices) p += axes * Vec3(radius * std::cos(angle), radius * std::sin(angle), 0);
    return mesh;
  };
  // The least angle between the tool and a post that it does not meet, on each side.
  const auto touch = [&](double side) {
    double meets = 0, clear = pi / 2;
    for (int k = 0; k < 40; ++k) {
      const double middle = (meets + clear) / 2;
      (Brute({post(from + side * middle)}, use, fastener).free(from, 0) ? clear : meets) = middle;
    }
    return clear;
  };
  const double before = touch(-1), after = touch(1), end = from + use.swing + spare + after;
  std::vector<Mesh> out{post(from - before), post(end)};
  EXPECT_GT(std::min(before, after), 1e-2);
  if (before + after < 1e-2) return out;
  for (double angle = end + 0.9 * (before + after); angle < from - before + 2 * pi; angle += 0.9 * (before + after))
    out.push_back(post(angle));
  for (int k = 0; k < 8; ++k) {
    const Mesh mesh = block(rng, 14, 70, 40);
    if (Brute({mesh}, use, fastener).free_swing(from, use.swing + spare, 60)) out.push_back(mesh);
  }
  return out;
}

/// Law: against many sampled placements, none is missed, in scenes with much room, with none, and with so little that
/// fewer than one sample in a thousand finds it. All counts of the nightly form are those that are asked for.
TEST(FindAccess, MissesNoPlacementThatSamplingFinds) {
  Rng rng(57);
  const int scenes = testing_support::trials(18, 200), samples = testing_support::trials(300, 100000);
  int none = 0, narrow = 0;
  for (int round = 0; round < scenes; ++round) {
    Fastener fastener = m3();
    fastener.travel = rng.uniform(0, 6);
    fastener.axis = Vec3::UnitZ();
    const double spare = 2 * pi * rng.uniform(3e-4, 7e-4);
    Tool tool;
    std::vector<Mesh> parts;
    for (bool wanted = false; !wanted;) {
      tool = random_tool(rng);
      parts.clear();
      if (round % 3 == 2) {
        parts = narrow_scene(rng, tool.uses.front(), fastener, spare);
      } else {
        for (auto n = 2 + rng.below(round % 3 == 1 ? 40 : 14); n > 0; --n) parts.push_back(block(rng, 14, 60, 30));
      }
      wanted = round % 3 != 1 || !Scene(parts, fastener).find(tool).reaches();
    }
    Fastener turned = fastener;
    const Pose pose = shapes::random_pose(rng, 40);
    turned.axis = pose.q * fastener.axis;
    turned.top = pose * fastener.top;
    for (Mesh& part : parts) part = shapes::moved(part, pose);
    const Use& use = tool.uses.front();
    const Brute brute(parts, use, turned);
    const Access access = Scene(parts, turned).find(tool);
    EXPECT_TRUE(!access.reaches() || brute.free_swing(access.start, use.swing, 40)) << "round " << round;
    int hits = 0;
    // Where a placement is reported and many samples find one, nothing is left to be shown.
    for (int k = 0; k < samples && !(access.reaches() && hits * 1000 >= samples); ++k) {
      const double start = rng.uniform(0, 2 * pi);
      hits += brute.free_swing(start, use.swing, 12) && brute.free_swing(start, use.swing, 80);
    }
    EXPECT_TRUE(hits == 0 || access.reaches()) << "round " << round << ": " << hits << " of " << samples;
    none += !access.reaches();
    // Few samples do not show how little room there is; the scene was made so.
    narrow += access.reaches() && (testing_support::nightly() ? hits * 1000 < samples : round % 3 == 2);
  }
  std::printf("%d scenes of %d samples: %d without any placement, %d that fewer than one sample in 1000 finds\n",
              scenes, samples, none, narrow);
  EXPECT_GE(none * 10, scenes * 3);
  EXPECT_GE(narrow * 10, scenes * 3);
}

/// Law: however little room there is, it is found. Blocks leave a gap that is wider than the swing by a thousandth of a
/// turn.
TEST(FindAccess, FindsTheLastGap) {
  Rng rng(56);
  for (int round = 0; round < testing_support::trials(60, 1000); ++round) {
    Tool tool;
    Use& use = tool.uses.emplace_back();
    use.swing = rng.uniform(0.05, 1);
    const double half = rng.uniform(1, 3), gap = rng.uniform(0, 2 * pi), spare = 2 * pi * rng.uniform(2e-4, 1e-3);
    use.tool = {box({0, -half}, {50, half}, 10, 14)};
    // Posts at 40 mm; the handle touches one of radius 1 at asin((half + 1) / 40) from its middle.
    std::vector<Mesh> posts;
    const double touch = std::asin((half + 1) / 40);
    const auto post = [&](double angle) {
      posts.push_back(shapes::tube(0, 1, 0, 30, 96, 1, rng.uniform()));
      for (Vec3& p : posts.back().vertices) p += Vec3(40 * std::cos(angle), 40 * std::sin(angle), 0);
    };
    const double width = use.swing + spare + 2 * touch;
    for (double angle = width; angle < 2 * pi; angle += 1.9 * touch) post(gap + angle);
    post(gap);
    const Fastener fastener = m3();
    const Access access = Scene(posts, fastener).find(tool);
    ASSERT_TRUE(access.reaches()) << "round " << round;
    EXPECT_TRUE(Brute(posts, use, fastener).free_swing(access.start, use.swing, 30));
    use.swing += 2 * spare + 1e-3;
    const Access more = Scene(posts, fastener).find(tool);
    EXPECT_FALSE(more.reaches()) << "round " << round;
    EXPECT_EQ(more.obstacles.size(), 1u);
  }
}

}  // namespace
}  // namespace dismantle::tools
