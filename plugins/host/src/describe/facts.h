/// Facts about types and parameters in words; shared by all formats of a description.
#pragma once

#include <string>
#include <vector>

#include "dismantle/host/registry.h"
#include "dismantle/plugin.h"

namespace dismantle {

/// "number"; of plugins "path_planner" or "list of path_planner".
std::string type_name(const ParamSpec& spec);
/// Default as it would stand in YAML; empty text is shown as "", plugins without their parameters.
std::string default_text(const ParamSpec& spec);
/// Range or choices: ">= 0", "translation | rotation | auto".
std::string limits_text(const ParamSpec& spec);
/// "dynamics, contacts", "2 parts moving simultaneously"; empty when nothing is said.
std::vector<std::string> capability_words(const Capabilities& c);
/// The declarations, each followed by those of the options of its items, as `of[].after`.
std::vector<ParamSpec> with_options(const std::vector<ParamSpec>& specs);
/// What a preset stands for, as YAML: its type with all parameters, and those of the plugins that it holds.
std::string expansion(const RegisteredType& preset, const Registry& registry);
std::string joined(const std::vector<std::string>& words, const std::string& between = ", ");

}  // namespace dismantle
