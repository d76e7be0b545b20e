/// Facts about types and parameters in words; shared by all formats of a description.
#pragma once

#include <string>
#include <vector>

#include "dismantle/plugin.h"

namespace dismantle {

std::string type_name(ParamType type);
/// Default as it would stand in YAML; empty text is shown as "".
std::string default_text(const ParamSpec& spec);
/// Range or choices: ">= 0", "translation | rotation | auto".
std::string limits_text(const ParamSpec& spec);
/// "dynamics, contacts", "2 parts moving at once"; empty when nothing is said.
std::vector<std::string> capability_words(const Capabilities& c);
std::string joined(const std::vector<std::string>& words, const std::string& between = ", ");

}  // namespace dismantle
