/// Texts about types and parameters, shared by all formats of a description.
#pragma once

#include <string>
#include <vector>

#include "dismantle/host/registry.h"
#include "dismantle/plugin.h"

namespace dismantle {

/// "number"; for plugin parameters "path_planner" or "list of path_planner".
std::string type_name(const ParamSpec& spec);
/// Default in the form of YAML; empty text as "", plugins without their parameters.
std::string default_text(const ParamSpec& spec);
/// Range or choices: ">= 0", "translation | rotation | auto".
std::string limits_text(const ParamSpec& spec);
/// "dynamics, contacts", "2 parts moving simultaneously"; empty when none is declared.
std::vector<std::string> capability_words(const Capabilities& c);
/// The declared or the advanced parameters; each is followed by the options of its items, named like `of[].after`.
std::vector<ParamSpec> with_options(const std::vector<ParamSpec>& specs, bool advanced);
/// Expansion of a preset as YAML: its type with all parameters, nested plugins included.
std::string expansion(const RegisteredType& preset, const Registry& registry);
std::string joined(const std::vector<std::string>& words, const std::string& between = ", ");

}  // namespace dismantle
