// Laws of `dismantle check`: each problem is found at its location and with its depth; nothing else is reported.
#include "dismantle/preparation/check_assembly.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "dismantle/errors.h"
#include "dismantle/samples/samples.h"
#include "dismantle/testing/fake_planning.h"

namespace dismantle {
namespace {

constexpr double kTolerance = 1e-4;

RawPart raw_box(const std::string& name, const Eigen::Vector3d& lo, const Eigen::Vector3d& hi) {
  return {name, name + ".obj", fake::boxes({{lo, hi}})};
}

AssemblyCheck checked(std::vector<RawPart> parts, const PrepareOptions& options = {}) {
  RunContext context;
  PrepareReport report;
  const Assembly assembly = prepare_assembly(std::move(parts), "test", "", options, context, report);
  return check_assembly(assembly, report, kTolerance, context);
}

std::vector<Finding> of_kind(const AssemblyCheck& check, FindingKind kind) {
  std::vector<Finding> found;
  std::copy_if(check.findings.begin(), check.findings.end(), std::back_inserter(found),
               [kind](const Finding& f) { return f.kind == kind; });
  return found;
}

TEST(CheckAssembly, BoxesThatTouchHaveNoFindings) {
  const AssemblyCheck check = checked({raw_box("a", {0, 0, 0}, {10, 10, 10}), raw_box("b", {10, 0, 0}, {20, 10, 10})});
  EXPECT_TRUE(check.findings.empty()) << findings_text(check, "test");
  EXPECT_EQ(check.parts, 2u);
  EXPECT_EQ(check.usable, 2u);
}

TEST(CheckAssembly, OverlapOfBoxesIsMeasuredAndPlaced) {
  Rng rng(7);
  for (int trial = 0; trial < 12; ++trial) {
    const double depth = rng.uniform(0.05, 2), size = rng.uniform(5, 40);
    const Eigen::Vector3d shift(rng.uniform(-50, 50), rng.uniform(-50, 50), rng.uniform(-50, 50));
    const Eigen::Vector3d one = size * Eigen::Vector3d::Ones();
    const AssemblyCheck check =
        checked({raw_box("a", shift, shift + one),
                 raw_box("b", shift + Eigen::Vector3d(size - depth, 0, 0), shift + one + Eigen::Vector3d(size, 0, 0))});
    const auto overlaps = of_kind(check, FindingKind::overlap);
    ASSERT_EQ(overlaps.size(), 1u) << "depth " << depth << " size " << size;
    EXPECT_NEAR(*overlaps[0].depth, depth, 0.01 * depth + 1e-4 * size);
    const Eigen::Vector3d at = *overlaps[0].at - shift;
    EXPECT_GE(at.x(), size - depth - 1e-6 * size);
    EXPECT_LE(at.x(), size + 1e-6 * size);
    const bool deep = depth > 0.01 * (2 * size), slight = depth <= 0.005 * size;
    EXPECT_EQ(overlaps[0].severity, deep     ? Severity::error
                                    : slight ? Severity::note
                                             : Severity::warning)
        << "depth " << depth << " size " << size;
  }
}

/// A row of boxes, each a little in the next.
TEST(CheckAssembly, SlightOverlapsAreOneLineForPeopleAndAllThereForPrograms) {
  std::vector<RawPart> row;
  for (int i = 0; i < 5; ++i)
    row.push_back(raw_box(fmt::format("box_{}", i), {10 * i - 0.001 * (i + 1), 0, 0}, {10.0 * i + 10, 10, 10}));
  const AssemblyCheck check = checked(std::move(row));
  EXPECT_EQ(of_kind(check, FindingKind::overlap).size(), 4u);
  EXPECT_EQ(check.count(Severity::warning) + check.count(Severity::error), 0u);
  const std::string brief = findings_text(check, "test", false), whole = findings_text(check, "test", true);
  EXPECT_NE(brief.find("note: 4 pairs overlap slightly"), std::string::npos) << brief;
  EXPECT_NE(brief.find("by up to 0.005 ('box_3' and 'box_4')"), std::string::npos) << brief;
  EXPECT_EQ(brief.find("'box_0'"), std::string::npos) << brief;
  for (int i = 0; i < 4; ++i)
    EXPECT_NE(whole.find(fmt::format("'box_{}' and 'box_{}' overlap", i, i + 1)), std::string::npos) << whole;
  EXPECT_EQ(nlohmann::json::parse(findings_json(check)).at("findings").size(), 4u);
}

/// A plate of thickness 1 that is 0.02 deep in a block, and 0.004 deep: how deep that is for the plate, does not depend
/// on how the assembly is turned.
TEST(CheckAssembly, WhatIsSlightDoesNotDependOnThePose) {
  Rng rng(3);
  for (const double depth : {0.02, 0.004})
    for (int trial = 0; trial < 4; ++trial) {
      const Eigen::Quaterniond turn =
          trial == 0 ? Eigen::Quaterniond::Identity()
                     : Eigen::Quaterniond(rng.normal(), rng.normal(), rng.normal(), rng.normal()).normalized();
      std::vector<RawPart> parts{raw_box("block", {-20, -20, -40}, {20, 20, 0}),
                                 raw_box("plate", {-18, -18, -depth}, {18, 18, 1 - depth})};
      for (RawPart& part : parts)
        for (Eigen::Vector3d& v : part.mesh.vertices) v = turn * v;
      const auto overlaps = of_kind(checked(std::move(parts)), FindingKind::overlap);
      ASSERT_EQ(overlaps.size(), 1u);
      EXPECT_EQ(overlaps[0].severity, depth > 0.01 ? Severity::warning : Severity::note) << depth << " trial " << trial;
    }
}

/// With a kind it is a screw without its thread, else something to look at.
TEST(CheckAssembly, ScrewsWithoutThreadsAreNotes) {
  for (const char* kind : {"screw", "shaft"}) {
    RunContext context;
    PrepareReport report;
    Assembly assembly =
        prepare_assembly(samples::make_model("plain_bore_screw", {}).parts, "test", "", {}, context, report);
    for (Part& part : assembly.parts)
      if (part.name == "screw") part.kind = PartKind{.kind = kind, .confidence = 1};
    const auto overlaps = of_kind(check_assembly(assembly, report, kTolerance, context), FindingKind::overlap);
    ASSERT_EQ(overlaps.size(), 1u);
    EXPECT_EQ(overlaps[0].severity == Severity::note, std::string(kind) == "screw");
  }
}

TEST(CheckAssembly, PartInsideSolidIsEnclosed) {
  const AssemblyCheck check =
      checked({raw_box("block", {0, 0, 0}, {20, 20, 20}), raw_box("pin", {8, 8, 8}, {12, 12, 12}),
               raw_box("foot", {0, 0, -5}, {20, 20, 0})});
  const auto enclosed = of_kind(check, FindingKind::enclosed);
  ASSERT_EQ(enclosed.size(), 1u);
  EXPECT_EQ(enclosed[0].parts, (std::vector<std::string>{"pin", "block"}));
  EXPECT_EQ(enclosed[0].severity, Severity::error);
  EXPECT_TRUE(of_kind(check, FindingKind::overlap).empty());
}

TEST(CheckAssembly, DuplicatesAndOpenMeshesAreNamed) {
  RawPart open = raw_box("open", {0, 20, 0}, {10, 30, 10});
  open.mesh.triangles.resize(open.mesh.triangles.size() - 5);
  PrepareOptions options;
  options.repair = false;
  const AssemblyCheck check = checked({raw_box("a", {0, 0, 0}, {10, 10, 10}), raw_box("b", {10, 0, 0}, {20, 10, 10}),
                                       raw_box("copy of b", {10, 0, 0}, {20, 10, 10}), open},
                                      options);
  const auto open_ones = of_kind(check, FindingKind::open);
  ASSERT_EQ(open_ones.size(), 1u);
  EXPECT_EQ(open_ones[0].parts.front(), "open");
  EXPECT_EQ(open_ones[0].severity, Severity::note);
  EXPECT_NE(open_ones[0].message.find("open edges"), std::string::npos);
  options.open = OpenSurfaces::exclude;
  const AssemblyCheck without = checked({raw_box("a", {0, 0, 0}, {10, 10, 10}), raw_box("b", {10, 0, 0}, {20, 10, 10}),
                                         raw_box("copy of b", {10, 0, 0}, {20, 10, 10}), open},
                                        options);
  const auto duplicates = of_kind(without, FindingKind::duplicate), unusable = of_kind(without, FindingKind::unusable);
  ASSERT_EQ(duplicates.size(), 1u);
  EXPECT_EQ(duplicates[0].parts.front(), "copy of b");
  ASSERT_EQ(unusable.size(), 1u);
  EXPECT_EQ(unusable[0].parts.front(), "open");
  EXPECT_EQ(without.findings.front().severity, Severity::error);
}

TEST(CheckAssembly, PartAwayFromTheOthersIsIsolatedAndOthersAreNot) {
  Rng rng(11);
  for (int trial = 0; trial < 20; ++trial) {
    const double gap = rng.uniform(0.5, 30);
    const AssemblyCheck check = checked({raw_box("a", {0, 0, 0}, {10, 10, 10}), raw_box("b", {2, 2, 10}, {8, 8, 20}),
                                         raw_box("far", {10 + gap, 0, 0}, {20 + gap, 10, 10})});
    const auto isolated = of_kind(check, FindingKind::isolated);
    ASSERT_EQ(isolated.size(), 1u) << "gap " << gap;
    EXPECT_EQ(isolated[0].parts.front(), "far");
  }
}

const CheckedContact* contact_of(const AssemblyCheck& check, const std::string& a, const std::string& b) {
  for (const CheckedContact& c : check.contacts)
    if ((c.a == a && c.b == b) || (c.a == b && c.b == a)) return &c;
  return nullptr;
}

/// Every sample that overlaps: its contacts have the class and the depth of its truth, in input units, in the check and
/// in the assembly; what is clean has no overlap.
TEST(CheckAssembly, ContactsOfSamplesAreThoseOfTheirTruth) {
  for (const samples::Sample& sample : samples::list()) {
    const samples::Model model = samples::make_model(sample.name, {{"rotate_seed", std::int64_t{7}}});
    PrepareOptions options;
    options.drop_duplicates = false;
    RunContext context;
    PrepareReport report;
    const Assembly assembly = prepare_assembly(model.parts, sample.name, "", options, context, report);
    const AssemblyCheck check = check_assembly(assembly, report, kTolerance, context);
    SCOPED_TRACE(sample.name);
    const double scale = assembly.normalization.scale;
    std::size_t overlapping = 0;
    for (const CheckedContact& c : check.contacts)
      if (c.place.contact != ContactClass::clearance && c.place.contact != ContactClass::kissing) ++overlapping;
    EXPECT_EQ(static_cast<long>(overlapping),
              std::count_if(model.truth.contacts.begin(), model.truth.contacts.end(),
                            [](const samples::TruthContact& c) { return c.contact != ContactClass::kissing; }));
    for (const samples::TruthContact& truth : model.truth.contacts) {
      const CheckedContact* found = contact_of(check, truth.a, truth.b);
      ASSERT_TRUE(found) << truth.a << " " << truth.b;
      EXPECT_EQ(to_string(found->place.contact), to_string(truth.contact));
      EXPECT_NEAR(found->depth, truth.depth, truth.depth_error + 0.01 * truth.depth + 2 * kTolerance / scale);
      EXPECT_EQ(found->place.axis.has_value(), truth.contact == ContactClass::uniform_interference);
      if (truth.contact == ContactClass::kissing) continue;  // no overlap
      const bool reported = std::any_of(check.findings.begin(), check.findings.end(), [&](const Finding& f) {
        return f.contact == truth.contact &&
               std::is_permutation(f.parts.begin(), f.parts.end(), std::vector{truth.a, truth.b}.begin());
      });
      EXPECT_TRUE(reported);
    }
    for (const InitialOverlap& o : assembly.overlaps) {
      ASSERT_TRUE(o.place);
      const CheckedContact* found = contact_of(check, assembly.parts[o.a].name, assembly.parts[o.b].name);
      ASSERT_TRUE(found);
      EXPECT_EQ(found->place.contact, o.place->contact);
      Aabb region = o.place->region;
      region.inflate(1e-9);
      EXPECT_TRUE(region.contains(o.place->at));
    }
    const auto json = nlohmann::json::parse(findings_json(check));
    EXPECT_EQ(json["contacts"].size(), check.contacts.size());
  }
}

TEST(CheckAssembly, JsonHoldsEveryFinding) {
  const AssemblyCheck check =
      checked({raw_box("block \"x\" </script>", {0, 0, 0}, {20, 20, 20}), raw_box("pin", {8, 8, 8}, {12, 12, 12})});
  const auto json = nlohmann::json::parse(findings_json(check));
  EXPECT_EQ(json["findings"].size(), check.findings.size());
  EXPECT_EQ(json["errors"], check.count(Severity::error));
  EXPECT_EQ(json["findings"][0]["parts"][1], "block \"x\" </script>");
  EXPECT_GT(json["findings"][0]["depth"].get<double>(), 0);
}

/// A box whose faces are cut into cells, some of which are missing.
RawPart box_with_holes(const std::string& name, int holes) {
  const int n = 12;
  RawPart part{name, name + ".obj", {}};
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          if (i % 3 == 1 && j % 3 == 1 && holes-- > 0) continue;
          const auto corner = [&](int u, int v) {
            Eigen::Vector3d p;
            p[axis] = side * 10;
            p[(axis + 1) % 3] = 10.0 * u / n;
            p[(axis + 2) % 3] = 10.0 * v / n;
            part.mesh.vertices.push_back(p);
            return static_cast<std::uint32_t>(part.mesh.vertices.size() - 1);
          };
          const auto a = corner(i, j), b = corner(i + 1, j), c = corner(i + 1, j + 1), d = corner(i, j + 1);
          if (side == 1) {
            part.mesh.triangles.push_back({a, b, c});
            part.mesh.triangles.push_back({a, c, d});
          } else {
            part.mesh.triangles.push_back({a, c, b});
            part.mesh.triangles.push_back({a, d, c});
          }
        }
  return part;
}

TEST(CheckAssembly, RepairsAreSummedUpAndToldInFullOnRequest) {
  RawPart a = box_with_holes("a", 7);
  a.unit = "mm";
  RawPart b = raw_box("b", {10, 0, 0}, {20, 10, 10});
  b.unit = "mm";
  const AssemblyCheck check = checked({a, b});
  const auto repaired = of_kind(check, FindingKind::repaired);
  ASSERT_EQ(repaired.size(), 1u);
  EXPECT_NE(repaired[0].message.find("closed 7 holes, the largest 0.6944 mm2 at ("), std::string::npos)
      << repaired[0].message;
  const auto holes = [](const std::string& text) {
    std::size_t n = 0;
    for (std::size_t at = text.find("closed a hole"); at != std::string::npos; at = text.find("closed a hole", at + 1))
      ++n;
    return n;
  };
  EXPECT_EQ(holes(findings_text(check, "x")), 0u);
  EXPECT_EQ(holes(findings_text(check, "x", true)), 7u);
  EXPECT_EQ(holes(findings_json(check)), 7u);
}

TEST(CheckAssembly, SaysWhatPlanSaysAboutTheInput) {
  RawPart hidden = raw_box("ghost", {0, 0, 0}, {1, 1, 1});
  hidden.problem = "it is hidden";
  hidden.by_meaning = true;
  RawPart a = raw_box("a", {0, 0, 0}, {10, 10, 10}), b = raw_box("b", {10, 0, 0}, {20, 10, 10});
  a.unit = "mm";
  b.unit = "inch";
  const auto kinds = [](const AssemblyCheck& check) {
    std::vector<Severity> out;
    for (const Finding& f : of_kind(check, FindingKind::input)) out.push_back(f.severity);
    return out;
  };
  const AssemblyCheck check = checked({a, b, hidden});
  EXPECT_EQ(kinds(check), (std::vector<Severity>{Severity::warning, Severity::note})) << findings_text(check, "x");
  EXPECT_EQ(check.parts, 2u);
  EXPECT_TRUE(check.sound());
  hidden.by_meaning = false;
  EXPECT_FALSE(checked({a, b, hidden}).sound());
  RawPart copy = a;
  copy.name = "copy";
  const AssemblyCheck twice = checked({a, b, copy});
  EXPECT_LT(twice.usable, twice.parts);
  EXPECT_TRUE(twice.sound()) << "the part is there, as for `plan`";
}

}  // namespace
}  // namespace dismantle
