/// Selects the plugins for the contract tests and holds the expectations about them.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "dismantle/host/registry.h"

namespace dismantle::contract {

/// Selection by the command line. See usage() in main.cpp.
struct Selection {
  std::vector<std::filesystem::path> files;  ///< plugin files whose types are tested; loaded in addition to those found
  std::set<std::string> ids;                 ///< types that are tested
  std::filesystem::path expectations;        ///< empty: none
  std::filesystem::path examples;            ///< folder with files of the importers' formats; empty: none
};

/// Must be called before the tests are registered. @throws PluginError for a refused file or an unknown id, Error for
/// unreadable expectations.
void select(const Selection& selection);

/// All plugins that were found or named.
const Registry& registry();

/// Types of a kind to test: the selected ones, or all without a selection; never those of without_defaults().
std::vector<std::string> ids(PluginKind kind);

/// Types that are not tested because they have a required parameter.
std::vector<std::string> without_defaults();

/// Files of Selection::examples with one of these endings, in the order of their names.
std::vector<std::filesystem::path> examples(const std::vector<std::string>& endings);

/// True if the expectations contain "WHAT ID". Expectations about known plugins beyond the laws, one per line:
///   solves ID           the path planner solves each of the small assemblies
///   resumes ID          the path planner resumes a search, and solves what it solves from the start
///   skips ID LAW        the law does not apply to this type
///   has_no_defaults ID  it has a required parameter, so that no law is tried
bool expected(const std::string& what, const std::string& id);

/// Differences between the skipped laws, "ID LAW", and the expectations about the tested types; empty without
/// expectations.
std::vector<std::string> unexpected_skips(const std::set<std::string>& skipped);

/// The test name of a type id.
std::string test_name(const testing::TestParamInfo<std::string>& info);

}  // namespace dismantle::contract
