/// `dismantle plugins check`: the contract tests on a plugin.
#pragma once

#include <string>
#include <vector>

namespace dismantle::app {

/// Becomes the program dismantle_contract_tests that is installed beside this one, on plugin files or ids of types.
/// `examples`: folder with files that importers are tried on, or empty. `verbose`: names each law. Its exit status: 0
/// all laws hold, 1 some do not, 2 a plugin is refused or not found.
/// @throws Error when the program is not there.
[[noreturn]] void check_plugins(const std::vector<std::string>& plugins, const std::string& examples, bool verbose);

}  // namespace dismantle::app
