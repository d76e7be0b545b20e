/// `dismantle plugins check`: runs the contract tests on plugins.
#pragma once

#include <string>
#include <vector>

namespace dismantle::app {

/// Replaces this process by the program dismantle_contract_tests (installed beside this one). `plugins`: plugin files
/// or ids of types. `examples`: folder with input files for importers, or empty. `verbose`: names each law. Exit
/// status: 0 all laws hold, 1 some do not, 2 a plugin is refused or not found.
/// @throws Error when the program does not exist.
[[noreturn]] void check_plugins(const std::vector<std::string>& plugins, const std::string& examples, bool verbose);

}  // namespace dismantle::app
