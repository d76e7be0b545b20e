/// What a reader of one file found.
#pragma once

#include <string>
#include <vector>

#include "dismantle/importer.h"

namespace dismantle::mesh_files {

struct PartsOfFile {
  std::vector<RawPart> parts;         ///< those that cannot be used included
  std::vector<std::string> warnings;  ///< something may be wrong
  std::vector<std::string> notes;     ///< nothing is wrong
};

}  // namespace dismantle::mesh_files
