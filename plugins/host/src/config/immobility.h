/// The `immobility:` section: which provers run, in which order.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "dismantle/host/config.h"
#include "dismantle/host/config_bind.h"

namespace dismantle {

/// Reads the section (nullptr: it is not there); what is wrong with it goes to `problems`. Fills `origins`.
std::vector<PluginChoice> read_immobility(const ConfigNode* section, const Registry& registry, const KeyHomes& homes,
                                          std::map<std::string, std::string>& origins,
                                          std::vector<Diagnostic>& problems);

}  // namespace dismantle
