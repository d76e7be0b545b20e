#include "dismantle/plugin.h"

#include "mesh_files.h"

DISMANTLE_PLUGIN("dismantle.mesh_files", "0.1.0", "MIT", "https://github.com/dismantle") {
  r.add<dismantle::Importer, dismantle::mesh_files::MeshFiles, dismantle::mesh_files::MeshFilesParameters>(
      "mesh_files",
      "Triangle and polygon meshes: OBJ, STL, PLY, OFF in double precision; glTF, 3MF, DAE through assimp in a process "
      "of its own.",
      {.source = "appendix B.1, step 1"});
}
