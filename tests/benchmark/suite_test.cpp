// Suite files: what they mean, and that everything that is wrong is reported at once with its place.
#include "dismantle/bench/suite.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <tuple>

#include "dismantle/bench/campaign.h"
#include "dismantle/samples/samples.h"

namespace dismantle::bench {
namespace {

namespace fs = std::filesystem;

class SuiteTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("dismantle_suite_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(const std::string& text) {
    std::ofstream(folder_ / "suite.yaml") << text;
    return folder_ / "suite.yaml";
  }
  /// "line: message" of all that is wrong.
  std::vector<std::string> problems(const std::string& text) {
    std::vector<std::string> out;
    try {
      read_suite(write(text));
    } catch (const ConfigError& e) {
      for (const auto& d : e.diagnostics()) {
        EXPECT_EQ(fs::path(d.file).filename(), "suite.yaml") << d.text();
        EXPECT_GT(d.column, 0) << d.text();
        out.push_back(std::to_string(d.line) + ": " + d.message);
      }
    }
    return out;
  }

  fs::path folder_;
};

constexpr const char* kGood = R"(schema: 1
assemblies:
  - {sample: l_slot, category: slide}
  - {sample: machine, set: {parts: 5}, name: small}
planners:
  one: {}
  two: {set: {path_planner.turn: 20000}}
variants:
  plain: {}
  turned: {rotate: random, planners: [two], part: slider}
seeds: [1..3, 7]
limits: {timeout: 10}
)";

TEST_F(SuiteTest, TheMatrix) {
  const Suite suite = read_suite(write(kGood));
  ASSERT_EQ(suite.assemblies.size(), 2u);
  EXPECT_EQ(suite.assemblies[0].name, "l_slot");
  EXPECT_EQ(suite.assemblies[1].name, "small");
  EXPECT_EQ(suite.seeds, (std::vector<std::int64_t>{1, 2, 3, 7}));
  EXPECT_TRUE(suite.variants[1].rotate);
  EXPECT_EQ(suite.variants[1].part, "slider");
  EXPECT_EQ(matrix(suite).size(), 2u * 4 * 3);
  EXPECT_EQ(suite.planners[0].config.run.timeout, 10);
  EXPECT_FALSE(suite.planners[0].config.layout.enabled);
}

TEST_F(SuiteTest, APlannerHasSeedsOfItsOwn) {
  const Suite suite = read_suite(write(R"(schema: 1
assemblies: [{sample: l_slot}]
planners:
  random: {seeds: [1..3, 9]}
  one: {}
variants: {plain: {}, turned: {rotate: random, planners: [one]}}
)"));
  EXPECT_EQ(suite.planners[0].seeds, (std::vector<std::int64_t>{1, 2, 3, 9}));
  EXPECT_EQ(suite.planners[1].seeds, std::vector<std::int64_t>{1});
  std::vector<std::tuple<std::size_t, std::size_t, std::int64_t>> cells;  // planner, variant, seed
  for (const Cell& cell : matrix(suite)) cells.emplace_back(cell.planner, cell.variant, cell.seed);
  EXPECT_EQ(cells, (decltype(cells){{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 0, 2}, {0, 0, 3}, {0, 0, 9}}));
  const std::string text = dry_run_text(suite, CampaignOptions{});
  EXPECT_NE(text.find("4 seeds: 6 trials"), std::string::npos) << text;
  EXPECT_NE(text.find("planner random: blocking + guided + sdf_penalty, 4 seeds\n"), std::string::npos) << text;
  EXPECT_NE(text.find("planner one: blocking + guided + sdf_penalty\n"), std::string::npos) << text;
}

TEST_F(SuiteTest, SeedsOfAPlannerThatAreWrong) {
  const auto found = problems(R"(schema: 1
assemblies: [{sample: l_slot}]
planners:
  backwards: {seeds: 3..1}
  twice: {seeds: [1..3, 2]}
  empty: {seeds: []}
  map: {seeds: {first: 1}}
)");
  const std::vector<std::string> wanted = {
      "4: planners.backwards: seeds must be whole numbers >= 0 or ranges such as 1..6 (at most 100000), got '3..1'",
      "5: planners.twice: seeds names a seed twice", "6: planners.empty: seeds is empty",
      "7: planners.map: seeds must be whole numbers >= 0 or ranges such as 1..6 (at most 100000), got a map"};
  EXPECT_EQ(found, wanted) << testing::PrintToString(found);
}

TEST_F(SuiteTest, ShardsAreTheWhole) {
  const auto all = matrix(read_suite(write(kGood)));
  using Key = std::tuple<std::size_t, std::size_t, std::size_t, std::int64_t>;
  const auto key = [](const Cell& c) { return Key{c.assembly, c.variant, c.planner, c.seed}; };
  for (unsigned n : {1u, 2u, 5u, 30u}) {
    std::multiset<Key> together, whole;
    for (const Cell& c : all) whole.insert(key(c));
    for (unsigned i = 1; i <= n; ++i)
      for (const Cell& c : shard_of(all, i, n)) together.insert(key(c));
    EXPECT_EQ(together, whole);
  }
}

TEST_F(SuiteTest, EverythingThatIsWrongAtOnce) {
  const auto found = problems(R"(schema: 1
assemblies:
  - {sample: l_slott}
  - {sample: machine, set: {partz: 5}}
  - {path: nowhere, glob: x}
planners:
  one: {set: {path_planner.trun: 20000}}
  two: {confg: x.yaml}
variants:
  turned: {rotate: randm, planners: [tow]}
seeds: 3..1
limits: {timeot: 10}
sedes: 2
)");
  const std::vector<std::pair<std::string, std::string>> wanted = {
      {"3: ", "did you mean 'l_slot'?"}, {"4: ", "did you mean 'parts'?"},  {"5: ", "exactly one of glob, path"},
      {"7: ", "did you mean 'turn'?"},   {"8: ", "did you mean 'config'?"}, {"10: ", "did you mean 'random'?"},
      {"10: ", "did you mean 'two'?"},   {"11: ", "seeds must be whole"},   {"12: ", "did you mean 'timeout'?"},
      {"13: ", "did you mean 'seeds'?"}};
  for (const auto& [line, text] : wanted) {
    bool there = false;
    for (const auto& problem : found) there |= problem.starts_with(line) && problem.find(text) != std::string::npos;
    EXPECT_TRUE(there) << line << text << "\n" << testing::PrintToString(found);
  }
  EXPECT_EQ(found.size(), wanted.size()) << testing::PrintToString(found);
}

TEST_F(SuiteTest, ConstraintsAndImportersAreThoseOfTheSuite) {
  const std::string sections = R"(constraints: {base: [frame], overlap: [{parts: [a, b], depth: 0.5}]}
importers: {step: {linear_deflection: 0.005}}
)";
  const Suite suite = read_suite(write(kGood + sections));
  for (const SuitePlanner& planner : suite.planners) {
    EXPECT_EQ(planner.config.constraints.base, std::vector<std::string>{"frame"});
    EXPECT_EQ(planner.config.constraints.overlap, (std::vector<NamedOverlap>{{"a", "b", 0.5}}));
    EXPECT_EQ(planner.config.importers.at("step").at("linear_deflection"), ParamValue(0.005));
  }
  const auto wrong = problems(kGood + std::string("constraints: {bsae: [frame]}\n"));
  ASSERT_EQ(wrong.size(), 1u) << testing::PrintToString(wrong);  // once, not once for each planner
  EXPECT_TRUE(wrong[0].starts_with("13: ") && wrong[0].find("did you mean 'base'?") != std::string::npos) << wrong[0];
}

TEST_F(SuiteTest, APlannerHasNoConstraintsAndImportersOfItsOwn) {
  const auto set = problems(R"(schema: 1
assemblies: [{sample: l_slot}]
planners:
  one: {set: {constraints.base: [frame]}}
  two: {set: {importers.step.linear_deflection: 0.005}}
)");
  ASSERT_EQ(set.size(), 2u) << testing::PrintToString(set);
  EXPECT_TRUE(set[0].starts_with("4: ") && set[0].find("write 'constraints:' at its top level") != std::string::npos);
  EXPECT_TRUE(set[1].starts_with("5: ") && set[1].find("write 'importers:' at its top level") != std::string::npos);
  for (const char* section : {"constraints: {target: frame}", "importers: {step: {linear_deflection: 0.005}}"}) {
    std::ofstream(folder_ / "planner.yaml") << "schema: 1\n" << section << "\n";
    try {
      read_suite(write("schema: 1\nassemblies: [{sample: l_slot}]\nplanners: {one: {config: planner.yaml}}\n"));
      ADD_FAILURE() << "accepted: " << section;
    } catch (const ConfigError& e) {
      const std::string text = e.what();
      EXPECT_NE(text.find("planner.yaml:2"), std::string::npos) << text;
      EXPECT_NE(text.find("the suite has them for all"), std::string::npos) << text;
    }
  }
}

TEST_F(SuiteTest, WhatIsToBeSolvedIsTheSameForAllPlanners) {
  std::ofstream(folder_ / "odd.yaml") << "schema: 1\nassembly: {open: exclude, subdivide: 0.2}\n"
                                         "verify: {max_penetration: 0.5}\n";
  const std::string planners =
      "schema: 1\nassemblies: [{sample: l_slot}]\nplanners: {odd: {config: odd.yaml}, plain: {}}\n";
  const std::map<std::string, std::string> wanted = {
      {"", "wall"}, {"assembly: {open: exclude}\n", "exclude"}, {"assembly: {size: 20}\n", "wall"}};
  for (const auto& [section, open] : wanted) {
    const Suite suite = read_suite(write(planners + section + "verify: {max_penetration: 0.02}\n"));
    ASSERT_EQ(suite.planners.size(), 2u);
    const auto& odd = suite.planners[0].config.sections;
    const auto& plain = suite.planners[1].config.sections;
    EXPECT_EQ(to_text(odd.at("assembly").at("open")), open);
    EXPECT_EQ(odd.at("assembly").at("subdivide"), ParamValue(0.2)) << "it is the planner's";
    for (const auto& [key, value] : plain.at("assembly"))
      if (key != "subdivide") {
        EXPECT_EQ(odd.at("assembly").at(key), value) << key;
      }
    const double size = section.find("20") == std::string::npos ? 1 : 2;
    EXPECT_EQ(odd.at("verify").at("max_penetration"), ParamValue(0.02 * size));
    EXPECT_EQ(plain.at("verify"), odd.at("verify"));
    std::string notes;
    for (const std::string& note : suite.notes) notes += note + "\n";
    EXPECT_EQ(notes.find("planners.odd: assembly.open is wall for all planners of the suite, not exclude") !=
                  std::string::npos,
              open == "wall")
        << notes;
    EXPECT_NE(notes.find("planners.odd: verify.max_penetration is"), std::string::npos) << notes;
    EXPECT_EQ(notes.find("planners.plain"), std::string::npos) << notes;
  }
  for (const char* key : {"verify.max_penetration: 0.1", "assembly.open: exclude", "components.level: solid"})
    EXPECT_EQ(
        problems(std::string("schema: 1\nassemblies: [{sample: l_slot}]\nplanners:\n  one: {set: {") + key + "}}\n")
            .size(),
        1u)
        << key;
}

TEST_F(SuiteTest, TheObjectiveIsThatOfPlannersWithoutOne) {
  const std::string text =
      "schema: 1\nassemblies: [{sample: l_slot}]\nplanners:\n  own: {set: {objective: [travel]}}\n  plain: {}\n";
  for (const bool stated : {false, true}) {
    const Suite suite = read_suite(write(text + (stated ? "objective: [directions, base]\n" : "")));
    ASSERT_EQ(suite.planners.size(), 2u);
    ASSERT_EQ(suite.planners[0].config.objective.size(), 1u);
    EXPECT_EQ(suite.planners[0].config.objective[0].type, "travel");
    EXPECT_EQ(suite.planners[1].config.objective.size(), stated ? 2u : 0u);
  }
}

TEST_F(SuiteTest, WhatIsMissing) {
  EXPECT_EQ(problems("schema: 1\n").size(), 2u);  // assemblies, planners
  EXPECT_EQ(problems("schema: 1\nassemblies: [{glob: 'no/*'}]\nplanners: {a: }\n").size(), 1u);
  EXPECT_EQ(problems("schema: 1\nassemblies: [{path: $NO_SUCH_VARIABLE/x}]\nplanners: {a: }\n").size(), 1u);
  EXPECT_EQ(problems("schema: 1\nassemblies: [{sample: l_slot}]\nplanners: {a: }\nlimits: {timeout: 0}\n").size(), 1u);
}

TEST_F(SuiteTest, OptionalIsLeftAsideWithANote) {
  const Suite suite =
      read_suite(write("schema: 1\nassemblies: [{glob: 'no/*', optional: true}, {path: $NO_SUCH_VARIABLE/x, optional: "
                       "true}, {sample: l_slot}]\n"
                       "planners: {a: }\n"));
  EXPECT_EQ(suite.assemblies.size(), 1u);
  EXPECT_EQ(suite.notes.size(), 2u);
}

TEST_F(SuiteTest, GlobsInNaturalOrderWithExceptions) {
  for (const char* name : {"10", "9", "plans"}) fs::create_directories(folder_ / "data" / name);
  std::ofstream(folder_ / "data" / "truth.json") << "{}";
  const Suite suite =
      read_suite(write("schema: 1\nassemblies: [{glob: 'data/*/', except: [plans], category: x}]\nplanners: {a: }\n"));
  ASSERT_EQ(suite.assemblies.size(), 2u);
  EXPECT_EQ(suite.assemblies[0].name, "data/9");
  EXPECT_EQ(suite.assemblies[1].name, "data/10");
  EXPECT_EQ(problems("schema: 1\nassemblies: [{glob: 'data/*/', except: [plan]}]\nplanners: {a: }\n").size(), 1u);
}

// Law: every suite in configs/bench reads, with what is here. Where there are no data, empty folders stand for those
// that suites without a sample need.
TEST_F(SuiteTest, OfTheProject) {
  const char* data = std::getenv("DISMANTLE_DATA");
  if (data == nullptr) {
    for (const char* name : {"cad/asap_beam", "threads/m10_bolt_nut", "two_part/skew_peg"})
      fs::create_directories(folder_ / "data" / name);
    setenv("DISMANTLE_DATA", (folder_ / "data").c_str(), 1);
  }
  std::size_t found = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(CONFIGS_FOLDER) / "bench")) {
    if (entry.path().extension() != ".yaml") continue;
    ++found;
    try {
      EXPECT_FALSE(matrix(read_suite(entry.path())).empty()) << entry.path();
    } catch (const ConfigError& e) {
      ADD_FAILURE() << e.what();
    }
  }
  EXPECT_GE(found, 4u);
  if (data == nullptr) unsetenv("DISMANTLE_DATA");
}

std::size_t parts_of(const SuiteAssembly& assembly) {
  if (assembly.path.empty()) return samples::make(assembly.sample, assembly.sample_values).size();
  std::size_t count = 0;
  for (const auto& file : fs::directory_iterator(assembly.path)) count += file.path().extension() == ".obj" ? 1 : 0;
  return count;
}

// Law: suites of two-part assemblies hold two-part assemblies. Of the data: where they are here.
TEST(Suites, OfTwoPartAssemblies) {
  for (const char* name : {"two_part", "rotational", "results_two_part", "results_rotational"}) {
    const Suite suite = read_suite(fs::path(CONFIGS_FOLDER) / "bench" / (std::string(name) + ".yaml"));
    for (const SuiteAssembly& assembly : suite.assemblies)
      EXPECT_EQ(parts_of(assembly), 2u) << name << ": " << assembly.name;
  }
}

TEST_F(SuiteTest, TablesNameColumnsOfTrialsCountsAndChecks) {
  const Suite suite =
      read_suite(write(std::string(kGood) +
                       "tables:\n  - {id: a.b, columns: [steps, counts.x, checks.y], trials: all}\nsearch_nodes: 9\n"));
  ASSERT_EQ(suite.tables.size(), 1u);
  EXPECT_EQ(suite.tables[0].title, "a.b");
  EXPECT_EQ(suite.tables[0].columns, (std::vector<std::string>{"steps", "counts.x", "checks.y"}));
  EXPECT_TRUE(suite.tables[0].all_trials);
  EXPECT_EQ(suite.search_nodes, 9);
  const auto wrong = problems(std::string(kGood) +
                              "tables:\n"
                              "  - {id: ok, columns: [step, outcome, counts.]}\n"
                              "  - {id: time, columns: [steps]}\n"
                              "  - {id: Bad, columns: []}\n"
                              "plugins: {search_paths: [nowhere]}\n");
  ASSERT_EQ(wrong.size(), 7u) << testing::PrintToString(wrong);
  EXPECT_NE(wrong[0].find("did you mean 'steps'"), std::string::npos) << wrong[0];
  EXPECT_NE(wrong[3].find("there is already a table 'time'"), std::string::npos) << wrong[3];
  EXPECT_NE(wrong[6].find("does not exist"), std::string::npos) << wrong[6];
}

}  // namespace
}  // namespace dismantle::bench
