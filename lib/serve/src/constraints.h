/// The constraints that are chosen in the page, as a configuration file and back.
#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <string>

namespace dismantle::serve {

/// A configuration with these constraints: {"base": [names], "ignore": [names], "flexible": [names],
/// "together": [[names], ...], "target": name}, all of which may be missing or empty. `extends`: file that it adds to;
/// empty: none. An empty text when there is nothing to constrain. @throws Error for anything else, also for names that
/// are not among `parts`.
std::string constraints_yaml(const nlohmann::json& constraints, const std::set<std::string>& parts,
                             const std::string& extends);

/// Those of such a file. @throws Error when it is no YAML of this form.
nlohmann::json constraints_in(const std::string& yaml);

}  // namespace dismantle::serve
