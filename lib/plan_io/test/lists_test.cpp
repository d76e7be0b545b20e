// The bill of materials and the steps as CSV.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <set>
#include <sstream>

#include "dismantle/errors.h"
#include "dismantle/plan_io/exports.h"
#include "dismantle/testing/shapes.h"
#include "random_disassembly.h"
#include "random_plan.h"

namespace dismantle {
namespace {

using Row = std::map<std::string, std::string>;

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> out(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') {
      if (quoted && i + 1 < line.size() && line[i + 1] == '"')
        out.back() += line[i++];
      else
        quoted = !quoted;
    } else if (line[i] == ',' && !quoted) {
      out.emplace_back();
    } else {
      out.back() += line[i];
    }
  }
  return out;
}

std::vector<std::string> names_in(const std::string& cell) {
  std::vector<std::string> out(1);
  for (const char c : cell)
    if (c == ';')
      out.emplace_back();
    else
      out.back() += c;
  return out;
}

std::vector<Row> rows_of(const std::string& csv) {
  std::istringstream in(csv);
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> header = fields_of(line);
  std::vector<Row> rows;
  while (std::getline(in, line)) {
    const std::vector<std::string> fields = fields_of(line);
    EXPECT_EQ(fields.size(), header.size()) << line;
    Row& row = rows.emplace_back();
    for (std::size_t i = 0; i < std::min(fields.size(), header.size()); ++i) row[header[i]] = fields[i];
  }
  return rows;
}

TEST(Lists, TheBillOfMaterialsHasEveryUnitOnce) {
  std::mt19937 random(7);
  auto [plan, assembly] = random_disassembly(random, 6);
  std::multiset<std::string> expected;
  for (const PlanPart& part : plan.assembly.parts) expected.insert(part.name);
  const auto listed = [&](const std::vector<Row>& rows) {
    std::multiset<std::string> names;
    for (const Row& row : rows) {
      const std::vector<std::string> parts = names_in(row.at("parts"));
      EXPECT_EQ(std::stoul(row.at("count")), parts.size());
      names.insert(parts.begin(), parts.end());
    }
    return names;
  };
  for (PlanPart& part : plan.assembly.parts) part.product = "document";  // bodies of one product are not one item
  for (const Row& row : rows_of(bom_csv(plan, assembly, input_frame(plan.assembly))))
    EXPECT_EQ(row.at("name"), names_in(row.at("parts")).front());
  EXPECT_EQ(listed(rows_of(bom_csv(plan, assembly, input_frame(plan.assembly)))), expected);
  const std::string one = plan.assembly.parts[0].name, two = plan.assembly.parts[1].name;
  plan.assembly.components = {{"motor 1", "motor", {one, two}, true, ""},
                              {"left open", "other", {plan.assembly.parts[2].name}, false, ""}};
  expected.erase(expected.find(one));
  expected.erase(expected.find(two));
  expected.insert("motor 1");
  const std::vector<Row> rows = rows_of(bom_csv(plan, assembly, input_frame(plan.assembly)));
  EXPECT_EQ(listed(rows), expected);
  EXPECT_EQ(rows.front().at("name"), "motor");
  plan.assembly.components.front().parts = {"no such part"};
  EXPECT_THROW(bom_csv(plan, assembly, input_frame(plan.assembly)), InputError);
}

TEST(Lists, StepsAreThoseOfTheAssembly) {
  std::mt19937 random(8);
  auto [plan, assembly] = random_disassembly(random, 6);
  const std::vector<Row> rows = rows_of(steps_csv(plan, input_frame(plan.assembly)));
  const std::size_t steps = plan.disassembly.size();
  ASSERT_EQ(rows.size(), steps);
  for (std::size_t n = 1; n <= steps; ++n) {
    const Row& row = rows[n - 1];
    const PlanStep& step = plan.disassembly[steps - n];
    EXPECT_EQ(row.at("step"), std::to_string(n));
    EXPECT_EQ(names_in(row.at("parts")).size(), step.moves.size());
    EXPECT_EQ(row.at("z"), "-1.000000") << "they leave upwards";
    EXPECT_EQ(row.at("travel"), "2");
    EXPECT_EQ(row.at("forced_depth"), "");
    // a waits for b in the assembly exactly if b waits for a in the disassembly
    std::set<std::string> waits;
    for (const PlanStep& other : plan.disassembly)
      if (std::ranges::find(other.after, step.step) != other.after.end())
        waits.insert(std::to_string(steps + 1 - other.step));
    std::set<std::string> stated;
    if (!row.at("waits_for").empty())
      for (const std::string& s : names_in(row.at("waits_for"))) stated.insert(s);
    EXPECT_EQ(stated, waits);
  }
  plan.disassembly[0].layer = 0;
  for (const Row& row : rows_of(steps_csv(plan, input_frame(plan.assembly)))) EXPECT_EQ(row.at("waits_for"), "unknown");
}

/// A plan of these parts, all of one kind.
std::size_t items_of(const std::vector<std::pair<std::string, Mesh>>& meshes, const std::string& kind) {
  const Assembly assembly = assembly_of_meshes(meshes, 1, Eigen::Vector3d::Zero());
  Plan plan;
  plan.assembly = described(assembly);
  for (PlanPart& part : plan.assembly.parts) part.kind = PartKind{kind, "M5", 0.9};
  return rows_of(bom_csv(plan, assembly, {})).size();
}

/// A bar whose section turns, as a coarse thread; `hand`: 1 or -1.
Mesh twisted(double hand, int rows, double length = 4) {
  Mesh m;
  const std::uint32_t n = 24;
  for (int k = 0; k <= rows; ++k)
    for (std::uint32_t i = 0; i < n; ++i) {
      const double a = 2 * std::numbers::pi * i / n, z = length * k / rows;
      const double r = 1 + 0.2 * std::cos(a - hand * 2 * z);
      m.vertices.emplace_back(r * std::cos(a), r * std::sin(a), z);
    }
  for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(rows); ++k)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = k * n + i, b = k * n + (i + 1) % n;
      m.triangles.push_back({a, b, b + n});
      m.triangles.push_back({a, b + n, a + n});
    }
  const auto low = static_cast<std::uint32_t>(m.vertices.size()), top = static_cast<std::uint32_t>(rows) * n;
  m.vertices.emplace_back(0, 0, 0);
  m.vertices.emplace_back(0, 0, length);
  for (std::uint32_t i = 0; i < n; ++i) {
    m.triangles.push_back({low, (i + 1) % n, i});
    m.triangles.push_back({low + 1, top + i, top + (i + 1) % n});
  }
  return m;
}

// Law: standard parts that only their triangles tell apart are one item, wherever they stand; others are not.
TEST(Lists, StandardPartsAreOneItemHoweverTheyAreMeshed) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Rng rng(seed);
    const auto placed = [&](const Mesh& mesh) { return shapes::moved(mesh, shapes::random_pose(rng, 30)); };
    const Mesh fine = placed(shapes::tube(2.5, 5, 0, 1, 48)), coarse = placed(shapes::tube(2.5, 5, 0, 1, 32, 1, 0.3));
    EXPECT_EQ(items_of({{"a", fine}, {"b", coarse}}, "washer"), 1u);
    EXPECT_EQ(items_of({{"a", fine}, {"b", coarse}}, "other"), 2u) << "it may be no standard part";
    EXPECT_EQ(items_of({{"a", fine}, {"b", placed(shapes::tube(2.5, 5, 0, 1.01, 32))}}, "washer"), 2u) << "a shim";
    EXPECT_EQ(items_of({{"a", fine}, {"b", placed(shapes::tube(2.5, 5.3, 0, 1, 32))}}, "washer"), 2u) << "wider";
    EXPECT_EQ(items_of({{"a", placed(twisted(1, 40))}, {"b", placed(twisted(1, 50))}}, "screw"), 1u);
    EXPECT_EQ(items_of({{"a", placed(twisted(1, 40))}, {"b", placed(twisted(-1, 50))}}, "screw"), 2u) << "left-handed";
  }
}

}  // namespace
}  // namespace dismantle
