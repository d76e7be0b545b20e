/// The parts of an assembly as nodes, meshes and materials of glTF.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/geometry/congruent_parts.h"
#include "dismantle/plan.h"
#include "dismantle/plan_io/input_frame.h"
#include "glb/glb_file.h"

namespace dismantle {

/// Node 0 turns the input's axes to Y up and its unit to metres; node 1 + i is part i of the assembly, named as the
/// part. Congruent parts share the arrays of their surface, and the mesh too when they have one colour.
class GlbScene {
 public:
  GlbScene(const Plan& plan, const Assembly& assembly, const InputFrame& frame);

  std::size_t node_of(std::size_t part) const { return 1 + part; }
  /// Translation and rotation of node_of(part) that put the part at `displacement` (input units; the identity is the
  /// assembled pose).
  Pose node_pose(std::size_t part, const Pose& displacement) const;
  /// Places a part permanently.
  void place(std::size_t part, const Pose& displacement);
  GlbBuffer& buffer() { return buffer_; }
  /// The file. `animations`: an array, may be empty.
  std::vector<std::uint8_t> file(const Plan& plan, const char* scene_name, GlbJson animations) const;

 private:
  struct Body {
    Pose shape;              ///< maps the drawn shape to the assembled part; input units
    Eigen::Vector3d center;  ///< of that shape, the origin of its arrays; input units
  };
  Eigen::Vector3d origin_;  ///< of the part nodes; input units
  std::vector<Body> bodies_;
  GlbJson nodes_ = GlbJson::array(), meshes_ = GlbJson::array(), materials_ = GlbJson::array();
  GlbBuffer buffer_;
};

}  // namespace dismantle
