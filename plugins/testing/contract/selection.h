/// Which plugins the contract tests are about, and what is expected of them.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "dismantle/host/registry.h"

namespace dismantle::contract {

/// What the command line says. See usage() in main.cpp.
struct Selection {
  std::vector<std::filesystem::path>
      files;                           ///< plugin files whose types are tested; loaded besides those that are found
  std::set<std::string> ids;           ///< types that are tested
  std::filesystem::path expectations;  ///< empty: none
  std::filesystem::path examples;      ///< folder with files of the importers' formats; empty: none
};

/// Has to be called before the tests are registered. @throws PluginError for a file that is refused or an id that no
/// plugin has, Error for expectations that cannot be read.
void select(const Selection& selection);

/// All plugins that are found, and those that are named.
const Registry& registry();

/// Types of a kind to be tested: the selected ones, without a selection all. Not those of without_defaults().
std::vector<std::string> ids(PluginKind kind);

/// Types that would be tested if they could be made without giving a parameter.
std::vector<std::string> without_defaults();

/// Files of Selection::examples with one of these endings, in the order of their names.
std::vector<std::filesystem::path> examples(const std::vector<std::string>& endings);

/// Expectations about plugins that are known, beyond the laws. One a line:
///   solves ID           the path planner solves each of the small assemblies
///   resumes ID          the path planner resumes a search, and solves what it solves from the start
///   skips ID LAW        the law does not concern this type
///   has_no_defaults ID  it cannot be made without giving a parameter, so that no law is tried
bool expected(const std::string& what, const std::string& id);

/// Differences between the laws that were skipped, "ID LAW", and the expectations about the types that were tested;
/// empty without expectations.
std::vector<std::string> unexpected_skips(const std::set<std::string>& skipped);

/// A type's id as the name of a test.
std::string test_name(const testing::TestParamInfo<std::string>& info);

}  // namespace dismantle::contract
