/// What a plugin type is and takes: for terminals, the reference and editors.
#pragma once

#include <string>

#include "dismantle/export.h"
#include "dismantle/host/registry.h"

namespace dismantle {

/// For a terminal: id, summary, source, capabilities, parameters, file and version; of a preset also what it stands for.
/// `registry` holds the type. Ends with a line break.
DISMANTLE_API std::string describe_text(const RegisteredType& type, const Registry& registry);
/// A page of the reference. Holds no path and no hash: the same wherever it was built.
DISMANTLE_API std::string describe_markdown(const RegisteredType& type, const Registry& registry);
/// One JSON object: {"id","kind","summary","source","needs","provides","parameters":[...],"plugin":{...}}, and of a
/// preset {"preset": {"of", "file"}}.
DISMANTLE_API std::string describe_json(const RegisteredType& type);

/// The sections `assembly`, `run` and `verify` of a configuration, as a page of the reference.
DISMANTLE_API std::string describe_sections_markdown();

/// JSON Schema (2020-12) of a configuration file, with the parameters of all types in `registry`.
DISMANTLE_API std::string json_schema(const Registry& registry);

}  // namespace dismantle
