/// What a plugin type is and takes: for terminals, the reference and editors.
#pragma once

#include <string>

#include "dismantle/export.h"
#include "dismantle/host/registry.h"

namespace dismantle {

/// For a terminal: id, summary, source, capabilities, parameters, file and version. Ends with a line break.
DISMANTLE_API std::string describe_text(const PluginType& type, const PluginFile& file);
/// A page of the reference. Holds no path and no hash: the same wherever it was built.
DISMANTLE_API std::string describe_markdown(const PluginType& type, const PluginFile& file);
/// One JSON object: {"id","kind","summary","source","needs","provides","parameters":[...],"plugin":{...}}.
DISMANTLE_API std::string describe_json(const PluginType& type, const PluginFile& file);

/// The sections `assembly`, `run` and `verify` of a configuration, as a page of the reference.
DISMANTLE_API std::string describe_sections_markdown();

/// JSON Schema (2020-12) of a configuration file, with the parameters of all types in `registry`.
DISMANTLE_API std::string json_schema(const Registry& registry);

}  // namespace dismantle
