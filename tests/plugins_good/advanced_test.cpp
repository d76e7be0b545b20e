// Advanced parameters are keys of the map `advanced` of the section or plugin that has them.
#include <gtest/gtest.h>

#include "dismantle/host/config.h"
#include "scratch.h"

namespace dismantle {
namespace {

class Advanced : public testing_support::Scratch {
 protected:
  static double lean(const PluginChoice& bfs) { return std::get<double>(bfs.parameters.at("lean")); }
  static const std::vector<PluginChoice>& of(const RunConfig& config) {
    return std::get<std::vector<PluginChoice>>(config.path_planner.parameters.at("of"));
  }
  static void expect_same(const RunConfig& a, const RunConfig& b) {
    EXPECT_EQ(a.path_planner, b.path_planner);
    EXPECT_EQ(a.simulator, b.simulator);
    EXPECT_EQ(a.provers, b.provers);
    EXPECT_EQ(a.sections, b.sections);
  }
};

constexpr const char* kEverywhere = R"(schema: 1
path_planner:
  type: team
  of:
    - {type: bfs, after: 5, advanced: {lean: 0.25, share: 0.5}}
    - t_rrt
    - {type: bfs, motion: rotation}
  advanced: {judge: {type: bfs, advanced: {last: translation}}}
immobility: {provers: [{type: ring, advanced: {heights: 7}}], advanced: {final_parts: 3}}
verify: {advanced: {tests: 5000}}
)";

TEST_F(Advanced, OfPluginsListsAndSections) {
  const RunConfig config =
      load_text(kEverywhere, {"path_planner.of.2.advanced.lean=0.75", "verify.advanced.patches=13"});
  EXPECT_EQ(config.warnings, std::vector<std::string>{});
  EXPECT_EQ(lean(of(config)[0]), 0.25);
  EXPECT_EQ(std::get<double>(of(config)[0].options.at("share")), 0.5);
  EXPECT_EQ(std::get<double>(of(config)[1].options.at("share")), 1.0) << "its default";
  EXPECT_EQ(lean(of(config)[2]), 0.75);
  const auto& judge = std::get<PluginChoice>(config.path_planner.parameters.at("judge"));
  EXPECT_EQ(std::get<std::string>(judge.parameters.at("last")), "translation");
  EXPECT_EQ(lean(judge), 0.5);
  EXPECT_EQ(std::get<std::int64_t>(config.provers.at(0).parameters.at("heights")), 7);
  EXPECT_EQ(config.proofs.final_parts, 3u);
  EXPECT_EQ(config.verify.budget.patches, 13u);
  EXPECT_EQ(config.verify.budget.tests, 5000u);
  EXPECT_EQ(config.origins.at("path_planner.of.0.advanced.lean"), "run.yaml:5");
  EXPECT_EQ(config.origins.at("verify.advanced.patches"), "<--set>:2");
  EXPECT_EQ(config.origins.at("verify.advanced.resolution"), "default");
}

TEST_F(Advanced, LayersMergeKeyByKey) {
  write("base.yaml", "schema: 1\npath_planner: {type: bfs, advanced: {lean: 0.25, last: translation}}\n");
  write("top.yaml", "schema: 1\nextends: base.yaml\npath_planner: {advanced: {lean: 0.75}}\n");
  const RunConfig config = load("top.yaml");
  EXPECT_EQ(lean(config.path_planner), 0.75);
  EXPECT_EQ(std::get<std::string>(config.path_planner.parameters.at("last")), "translation");
  EXPECT_EQ(lean(load("top.yaml", {"path_planner.type=guided"}).path_planner), 0.5) << "another type begins afresh";
}

TEST_F(Advanced, AllErrorsHaveTheirPlaces) {
  EXPECT_EQ(errors_of(R"(schema: 1
path_planner: {type: bfs, advanced: {lena: 0.5, motion: rotation, lean: 2}, laen: 1}
simulator: {type: sdf_penalty, advanced: {time_step: 0.1}}
immobility: {provers: [{type: ring, advanced: {heights: 7.5}}, {type: overlap_lock, advanced: 3}], advanced: [1]}
verify: {tsets: 3, advanced: {tests: 0, testz: 3}}
run: {lean: 1}
)"),
            R"(run.yaml:2:38: error: unknown key 'lena' in path_planner.advanced (bfs); did you mean 'lean'?
run.yaml:2:49: error: 'motion' is not an advanced parameter: write path_planner.motion
run.yaml:2:73: error: path_planner.advanced.lean must be in [0, 1], got 2 [bfs 0.1.0, libfixture.so]
run.yaml:2:77: error: unknown key 'laen' in path_planner (bfs); did you mean 'advanced.lean'?
run.yaml:3:32: error: unknown key 'advanced' in simulator (sdf_penalty)
run.yaml:4:57: error: immobility.provers.0.advanced.heights must be an integer, got '7.5' [ring 0.1.0, libfixture.so]
run.yaml:4:85: error: unknown key 'advanced' in immobility.provers.1 (overlap_lock)
run.yaml:4:110: error: immobility.advanced must be a map of keys, not a list
run.yaml:5:10: error: unknown key 'tsets' in verify; did you mean 'advanced.tests'?
run.yaml:5:38: error: verify.advanced.tests must be in [1, 1000000000000], got 0
run.yaml:5:41: error: unknown key 'testz' in verify.advanced; did you mean 'tests'?
run.yaml:6:7: error: unknown key 'lean' in run; it belongs to path_planner.advanced (bfs)
)");
}

// Law: configurations that were written before the map are read as before, and a warning says what to write.
TEST_F(Advanced, OutsideTheMapTheyAreReadWithAWarning) {
  const RunConfig now = load_text(kEverywhere);
  const RunConfig before = load_text(R"(schema: 1
path_planner:
  type: team
  of:
    - {type: bfs, after: 5, lean: 0.25, share: 0.5}
    - t_rrt
    - {type: bfs, motion: rotation}
  judge: {type: bfs, last: translation}
immobility: {provers: [{type: ring, heights: 7}]}
verify: {tests: 5000}
)",
                                     {"immobility.final_parts=3"});
  expect_same(now, before);
  const std::string text = "advanced parameters are keys of the map 'advanced': write ";
  EXPECT_EQ(
      before.warnings,
      (std::vector<std::string>{
          "run.yaml:5:29: " + text + "path_planner.of.0.advanced.lean, path_planner.of.0.advanced.share",
          "run.yaml:8:22: " + text + "path_planner.advanced.judge.advanced.last",
          "run.yaml:8:3: " + text + "path_planner.advanced.judge", "run.yaml:10:10: " + text + "verify.advanced.tests",
          "run.yaml:9:37: " + text + "immobility.provers.0.advanced.heights",
          "<--set>:1: " + text + "immobility.advanced.final_parts"}));
  EXPECT_EQ(errors_of("schema: 1\npath_planner: {type: bfs, lean: 2}\n"),
            "run.yaml:2:33: error: path_planner.advanced.lean must be in [0, 1], got 2 [bfs 0.1.0, libfixture.so]\n");
  EXPECT_EQ(errors_of("schema: 1\npath_planner: {type: bfs, lean: 0.25, advanced: {lean: 0.75}}\n"),
            "run.yaml:2:50: error: path_planner.advanced.lean is set twice, inside the map 'advanced' and outside\n");
}

// Law: resolved.yaml holds the advanced values that differ from their defaults, and gives the same configuration.
TEST_F(Advanced, ResolvedHoldsThoseThatDiffer) {
  const RunConfig config = load_text(kEverywhere);
  const std::string text = resolved_yaml(config, registry_, ".");
  for (const char* row :
       {"\n      advanced:\n        share: 0.5 ", "\n        lean: 0.25 ", "\n  advanced:\n    judge:\n",
        "\n      advanced:\n        last: translation ", "\n      advanced:\n        heights: 7 ",
        "\n  advanced:\n    final_parts: 3 ", "\n  advanced:\n    tests: 5000 "})
    EXPECT_NE(text.find(row), std::string::npos) << row << "\nnot in\n" << text;
  EXPECT_EQ(text.find("trial_share"), std::string::npos) << text;
  EXPECT_EQ(text.find("lean: 0.5"), std::string::npos) << text;
  const RunConfig again = load_text(text);
  EXPECT_EQ(again.warnings, std::vector<std::string>{});
  expect_same(config, again);
}

// Law: a value equal to the default of the type is written when the default of the parameter that holds it differs.
TEST_F(Advanced, ResolvedNamesWhatAPresetWouldChange) {
  for (const char* value : {"0.5", "0.25", "0.75"}) {
    const RunConfig config = load_text("schema: 1\npath_planner: {type: duo}\n",
                                       {std::string("path_planner.of.bfs.advanced.lean=") + value});
    expect_same(config, load_text(resolved_yaml(config, registry_, ".")));
    const RunConfig nested =
        load_text("schema: 1\npath_planner: {type: solo}\n",
                  {std::string("path_planner.advanced.judge={type: bfs, advanced: {lean: ") + value + "}}"});
    expect_same(nested, load_text(resolved_yaml(nested, registry_, ".")));
  }
}

}  // namespace
}  // namespace dismantle
