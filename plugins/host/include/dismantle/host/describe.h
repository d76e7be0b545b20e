/// Descriptions of plugin types and their parameters for terminals, the reference and editors.
#pragma once

#include <string>

#include "dismantle/export.h"
#include "dismantle/host/registry.h"

namespace dismantle {

/// For a terminal: id, summary, source, capabilities, parameters, file and version; for a preset also its expansion.
/// `registry` contains the type. Ends with a line break.
DISMANTLE_API std::string describe_text(const RegisteredType& type, const Registry& registry);
/// A page of the reference. Contains no path and no hash, so it is the same on every machine.
DISMANTLE_API std::string describe_markdown(const RegisteredType& type, const Registry& registry);
/// One JSON object: {"id","kind","summary","source","needs","provides","parameters":[...],"advanced":[...],
/// "plugin":{...}}, and for a preset also {"preset": {"of", "file"}}.
DISMANTLE_API std::string describe_json(const RegisteredType& type, const Registry& registry);

/// The sections of a configuration that have no plugin, as a page of the reference.
DISMANTLE_API std::string describe_sections_markdown();

/// All advanced parameters, of plugins and of sections, as a page of the reference.
DISMANTLE_API std::string describe_advanced_markdown(const Registry& registry);

/// JSON Schema (2020-12) of a configuration file, with the parameters of all types in `registry`.
DISMANTLE_API std::string json_schema(const Registry& registry);

}  // namespace dismantle
