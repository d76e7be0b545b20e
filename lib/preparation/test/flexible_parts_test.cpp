// Flexible parts are recognised by shape and contact: springs, seals and round belts, whatever their size, pose and
// triangulation, but not rigid parts that are as slender.
#include "dismantle/preparation/flexible_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>

#include "dismantle/geometry/strand.h"
#include "dismantle/preparation/check_assembly.h"
#include "dismantle/preparation/prepare.h"
#include "dismantle/samples/samples.h"
#include "dismantle/testing/shapes.h"
#include "dismantle/testing/strand_shapes.h"
#include "dismantle/testing/trials.h"

namespace dismantle {
namespace {

using namespace shapes;
using std::numbers::pi;

Mesh scattered(Mesh m, Rng& rng) {
  return anywhere(retriangulated(std::move(m), rng, static_cast<int>(rng.below(3))), rng);
}

Mesh random_coil(Rng& rng) {
  const double wire = 1, radius = wire * rng.uniform(1.6, 5), last = rng.below(3) == 0 ? 1.5 * radius : radius;
  std::vector<Vec3> line =
      coil_line(radius, last, wire * rng.uniform(1.1, 3), rng.uniform(2.4, 8), static_cast<int>(16 + rng.below(24)));
  if (rng.below(3) == 0) {  // the legs of a torsion spring
    const Vec3 end = line.back(), displacement = (line.back() - line[line.size() - 2]).normalized();
    for (int k = 1; k <= 4; ++k) line.push_back(end + k * 1.5 * displacement);
  }
  return sweep(line, polygon(wire / 2, static_cast<int>(10 + rng.below(14)), rng.uniform(0, pi)), false);
}

Mesh random_loop(Rng& rng) {
  const double thick = 1, r = thick * rng.uniform(1.6, 12);
  const double distance = rng.below(2) == 0 ? 0 : r * rng.uniform(2, 8);
  const double other = r * (distance > 0 ? rng.uniform(0.5, 1) : 1);
  const std::vector<Vec3> line =
      belt_line(r, std::max(1.6 * thick, other), distance, static_cast<int>(24 + rng.below(40)));
  return sweep(line, polygon(thick / 2, static_cast<int>(8 + rng.below(16)), rng.uniform(0, pi)), true);
}

TEST(FlexibleShape, CoilsAndLoopsWhateverTheirSizePlaceAndTriangles) {
  Rng rng(11);
  for (int trial = 0; trial < testing_support::trials(60, 1000); ++trial) {
    EXPECT_EQ(flexible_shape(scattered(random_coil(rng), rng)), Flexible::coil) << "trial " << trial;
    EXPECT_EQ(flexible_shape(scattered(random_loop(rng), rng)), Flexible::loop) << "trial " << trial;
  }
}

TEST(FlexibleShape, LengthThicknessAndTurnsOfAStrandAreThoseThatItWasMadeWith) {
  Rng rng(12);
  for (int trial = 0; trial < testing_support::trials(30, 500); ++trial) {
    const double radius = rng.uniform(2, 6), pitch = rng.uniform(1.2, 3), turns = rng.uniform(2.5, 6);
    const Mesh mesh = scattered(sweep(coil_line(radius, radius, pitch, turns, 40), polygon(0.5, 24), false), rng);
    const auto strand = geometry::follow_strand(mesh);
    ASSERT_TRUE(strand);
    const double unit =
        std::cbrt(volume(mesh) / volume(sweep(coil_line(radius, radius, pitch, turns, 40), polygon(0.5, 24), false)));
    const double length = turns * std::hypot(2 * pi * radius, pitch);
    EXPECT_FALSE(strand->closed);
    EXPECT_NEAR(strand->thickness, unit, 0.03 * unit);
    EXPECT_NEAR(strand->length, length * unit, 0.03 * length * unit);
    EXPECT_NEAR(strand->share, 1, 0.05);
    const double turned = turns * 2 * pi * radius / std::hypot(2 * pi * radius, pitch);
    EXPECT_NEAR(strand->coils, turned * 2 * pi * radius / std::hypot(2 * pi * radius, pitch), 0.25);
  }
}

/// Slender, round or coiled, and rigid.
Mesh random_rigid(Rng& rng) {
  const int sides = static_cast<int>(8 + rng.below(16));
  const double long_one = rng.uniform(10, 60);
  switch (rng.below(12)) {
    case 0:  // a rod
      return tube(0, 0.5, 0, long_one, sides, static_cast<int>(1 + rng.below(5)));
    case 1:  // a handle, a hook: bent by less than two turns
      return sweep(coil_line(rng.uniform(2, 8), rng.uniform(2, 8), rng.uniform(0, 1), rng.uniform(0.3, 0.95), 32),
                   polygon(0.5, sides), false);
    case 2:  // a washer
      return tube(rng.uniform(2, 4), rng.uniform(5, 10), 0, rng.uniform(0.2, 1), 40);
    case 3:  // a ring of a bearing, and thin ones
      return tube(8, 8 + rng.uniform(0.4, 1.5), 0, rng.uniform(0.4, 4), 48);
    case 4:  // a square frame
      return sweep(belt_line(2, 2, long_one, 32), polygon(0.7, 4, pi / 4), true);
    case 5:  // a thick ring
      return sweep(belt_line(1, 1, 0, 48), polygon(rng.uniform(0.5, 0.8), sides), true);
    case 6:  // a plate
      return box({0, 0, 0}, {long_one, rng.uniform(2, 30), rng.uniform(0.1, 1)});
    case 7:  // a bracket
      return sweep({{0, 0, 0}, {long_one, 0, 0}, {long_one, long_one, 0}}, polygon(0.7, 4, pi / 4), false);
    case 8:  // a pipe that coils: hollow
      return joined(sweep(coil_line(5, 5, 3, 4, 32), polygon(0.5, 16), false),
                    inside_out(sweep(coil_line(5, 5, 3, 4, 32), polygon(0.4, 16), false)));
    case 9: {  // a frame of bent tubes: its turns cancel out
      std::vector<Vec3> line;
      for (int k = 0; k < 60; ++k) line.emplace_back(0.8 * k, 4 * std::sin(0.25 * k), 0);
      return sweep(line, polygon(0.5, sides), false);
    }
    case 10:  // a key ring that is open
      return sweep(coil_line(6, 6, 0.02, 0.93, 48), polygon(0.5, sides), false);
    default:  // a thin sleeve
      return tube(4, 4.3, 0, long_one, 48, 3);
  }
}

TEST(FlexibleShape, RigidPartsAreNot) {
  Rng rng(13);
  for (int trial = 0; trial < testing_support::trials(150, 3000); ++trial) {
    EXPECT_EQ(flexible_shape(scattered(random_rigid(rng), rng)), std::nullopt) << "trial " << trial;
  }
}

/// Screws, nuts, gears, pins, washers, brackets, boxes: all that the project makes itself.
TEST(FlexibleShape, OfAllSamplesTheSpringAndTheSealAlone) {
  for (const samples::Sample& sample : samples::list())
    for (const std::int64_t seed : {0, 5})
      for (const RawPart& part : samples::make(sample.name, {{"rotate_seed", seed}})) {
        const auto kind = flexible_shape(part.mesh);
        if (part.name == "spring")
          EXPECT_EQ(kind, Flexible::coil) << sample.name;
        else if (sample.name == "o_ring" && part.name == "ring")
          EXPECT_EQ(kind, Flexible::loop);
        else
          EXPECT_EQ(kind, std::nullopt) << sample.name << ' ' << part.name;
      }
}

Assembly prepared(std::vector<RawPart> parts, PrepareReport& report, const PrepareOptions& options = {}) {
  RunContext context;
  return prepare_assembly(std::move(parts), "test", "", options, context, report);
}

Assembly prepared(std::vector<RawPart> parts, const PrepareOptions& options = {}) {
  PrepareReport report;
  return prepared(std::move(parts), report, options);
}

using Kinds = std::map<std::string, Flexible>;

Kinds kinds_in(std::vector<RawPart> parts, const PrepareOptions& options = {}) {
  PrepareReport report;
  prepared(std::move(parts), report, options);
  Kinds kinds;
  for (const FlexiblePart& f : report.flexible) kinds[f.part] = f.kind;
  return kinds;
}

const Part& part_named(const Assembly& assembly, const std::string& name) {
  return *std::find_if(assembly.parts.begin(), assembly.parts.end(), [&](const Part& p) { return p.name == name; });
}

TEST(FlexibleParts, SamplesAtRandom) {
  Rng rng(14);
  for (int trial = 0; trial < testing_support::trials(4, 60); ++trial) {
    const double wire = rng.uniform(1, 3), diameter = rng.uniform(4, 8) * wire, section = rng.uniform(2, 4);
    const auto seed = static_cast<std::int64_t>(1 + rng.below(1000));
    const ParamSet spring{{"wire", wire},
                          {"diameter", std::max(6.0, diameter)},
                          {"pitch", 2 * wire},
                          {"turns", rng.uniform(2.5, 6)},
                          {"rotate_seed", seed}};
    const ParamSet seal{{"section", section}, {"diameter", rng.uniform(4, 9) * section}, {"rotate_seed", seed}};
    for (const auto& [name, params, part] :
         {std::tuple("spring_between_seats", spring, "spring"), std::tuple("o_ring", seal, "ring")}) {
      auto parts = samples::make(name, params);
      const double scale = std::pow(10, rng.uniform(-2, 2));
      for (RawPart& raw : parts)
        for (Vec3& v : raw.mesh.vertices) v *= scale;
      PrepareReport report;
      const Assembly assembly = prepared(parts, report);
      const Part& bends = part_named(assembly, part);
      ASSERT_EQ(report.flexible.size(), 1u) << name;
      EXPECT_EQ(report.flexible[0].part, part);
      EXPECT_EQ(report.flexible[0].kind, std::string(part) == "spring" ? Flexible::coil : Flexible::loop);
      for (const InitialOverlap& o : assembly.overlaps) {
        const bool pair = o.a == bends.id || o.b == bends.id;
        EXPECT_EQ(o.declared, pair ? std::optional(flexible_depth(bends)) : std::nullopt);
        EXPECT_GE(assembly.initial_overlap(o.a, o.b), o.depth);
      }
      const double thick = std::string(part) == "spring" ? wire : section;
      EXPECT_NEAR(flexible_depth(bends), thick * scale * assembly.normalization.scale, 0.05 * flexible_depth(bends));
      const AssemblyCheck check = check_assembly(assembly, report, 1e-4, RunContext{});
      EXPECT_EQ(std::count_if(check.findings.begin(), check.findings.end(),
                              [&](const Finding& f) {
                                return f.kind == FindingKind::flexible && f.parts == std::vector<std::string>{part};
                              }),
                1);

      PrepareOptions rigid;
      rigid.flexible = FlexibleParts::declared;
      EXPECT_EQ(kinds_in(parts, rigid), Kinds{});
    }
  }
}

RawPart raw(const std::string& name, Mesh mesh) { return {name, name + ".obj", std::move(mesh)}; }

/// Links of a chain, a hoop that hangs on a pin: as slender as a seal, and touched in one place.
TEST(FlexibleParts, RoundHoopsThatAreTouchedInOnePlaceStayRigid) {
  Rng rng(15);
  for (int trial = 0; trial < testing_support::trials(6, 100); ++trial) {
    const double radius = rng.uniform(2.5, 8), cut = rng.uniform(0.02, 0.2);
    const Mesh hoop = sweep(belt_line(radius, radius, 0, 48), polygon(0.5, 16), true);
    ASSERT_EQ(flexible_shape(hoop), Flexible::loop);
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(pi / 2, Vec3::UnitX()));
    const Mesh link = moved(hoop, Pose{{2 * radius - 1 + cut, 0, 0}, turn});
    const Mesh pin = moved(tube(0, 1, -3, 3, 32), Pose{{radius - 1.5 + cut, 0, 0}, Eigen::Quaterniond::Identity()});
    for (const Mesh& other : {link, pin}) {
      const Assembly assembly = prepared({raw("hoop", hoop), raw("other", other)});
      ASSERT_EQ(assembly.overlaps.size(), 1u);
      EXPECT_FALSE(assembly.overlaps[0].declared);
      EXPECT_EQ(assembly.initial_overlap(0, 1), assembly.overlaps[0].depth);
    }
  }
}

/// Between two plates, and around a pulley.
TEST(FlexibleParts, LoopsThatAreHeldAlongTheirTurnsBend) {
  Rng rng(16);
  for (int trial = 0; trial < testing_support::trials(4, 60); ++trial) {
    const double radius = rng.uniform(3, 8), cut = rng.uniform(0.02, 0.15), wide = 3 * radius;
    const Mesh seal = sweep(belt_line(radius, radius, 0, 48), polygon(0.5, 16), true);
    const Mesh plate = box({-wide, -wide, -2}, {wide, wide, -0.5 + cut});
    EXPECT_EQ(kinds_in({raw("seal", seal), raw("plate", plate)}), (Kinds{{"seal", Flexible::loop}}));
    const Mesh belt = sweep(belt_line(radius, radius, 4 * radius, 48), polygon(0.5, 16), true);
    const Mesh pulley = tube(0, radius - 0.5 + cut, -1, 1, 96);
    EXPECT_EQ(kinds_in({raw("belt", belt), raw("pulley", pulley)}), (Kinds{{"belt", Flexible::loop}}));
  }
}

/// What the file says of a material holds for any shape, towards all others; recognition by shape may be off.
TEST(FlexibleParts, TheFileSaysThatAMaterialBends) {
  PrepareOptions options;
  options.flexible = FlexibleParts::declared;
  for (const bool bends : {false, true}) {
    std::vector<RawPart> raws{raw("block", box({0, 0, 0}, {4, 4, 4})), raw("plate", box({0, 0, -1}, {4, 4, 0.1})),
                              raw("lid", box({0, 0, 6}, {4, 4, 7}))};
    raws[0].flexible = bends;
    PrepareReport report;
    const Assembly assembly = prepared(raws, report, options);
    ASSERT_EQ(report.flexible.size(), bends ? 1u : 0u);
    const double depth = flexible_depth(assembly.parts[0]);
    EXPECT_NEAR(depth, assembly.normalization.scale * 4 * 64 / 96.0, 1e-9);
    for (const PartId other : {1u, 2u}) {
      const InitialOverlap* pair = assembly.overlap_of(0, other);
      EXPECT_EQ(pair != nullptr ? pair->declared : std::nullopt, bends ? std::optional(depth) : std::nullopt);
    }
    EXPECT_EQ(assembly.overlap_of(1, 2), nullptr);
    if (!bends) continue;
    EXPECT_EQ(report.flexible[0].part, "block");
    EXPECT_EQ(report.flexible[0].kind, Flexible::material);
    EXPECT_EQ(report.flexible[0].others, (std::vector<std::string>{"plate", "lid"}));
  }
}

TEST(FlexibleParts, WithoutAnOverlapNothingBends) {
  const Mesh seal = sweep(belt_line(5, 5, 0, 48), polygon(0.5, 16), true);
  const Assembly assembly = prepared({raw("seal", seal), raw("plate", box({-9, -9, -2}, {9, 9, -0.55}))});
  EXPECT_EQ(assembly.initial_overlap(0, 1), 0);
}

}  // namespace
}  // namespace dismantle
