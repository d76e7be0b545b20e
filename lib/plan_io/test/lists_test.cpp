// The bill of materials and the steps as CSV.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "dismantle/errors.h"
#include "dismantle/plan_io/exports.h"
#include "random_disassembly.h"

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

}  // namespace
}  // namespace dismantle
