/// Importers by the extension that they read.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "dismantle/importer.h"

namespace dismantle {

using Readers = std::map<std::string, std::shared_ptr<Importer>>;

inline Readers readers_of(const std::vector<std::shared_ptr<Importer>>& importers) {
  Readers readers;
  for (const auto& importer : importers)
    for (const auto& extension : importer->extensions()) readers.emplace(extension, importer);  // the first one wins
  return readers;
}

/// Which formats can be read, for messages.
inline std::string readable(const Readers& readers) {
  if (readers.empty()) return "no importer is loaded";
  std::string list;
  for (const auto& [extension, importer] : readers) list += (list.empty() ? "." : ", .") + extension;
  return "can be read: " + list;
}

}  // namespace dismantle
