/// Small assemblies of boxes in the sdf_penalty simulator.
#pragma once

#include <utility>
#include <vector>

#include "world_scene.h"

namespace dismantle::sdf_penalty::test {

using namespace sdf::test;

struct TestScene : sdf::test::TestScene {
  TestScene(std::vector<Mesh> meshes, const ParamSet& given, std::vector<InitialOverlap> overlaps = {})
      : sdf::test::TestScene("sdf_penalty", std::move(meshes), given, std::move(overlaps)) {}
};

/// With this spacing, boxes up to 5 units long have contact points only at their corners.
inline ParamSet with(ParamSet given) {
  given.try_emplace("contact_spacing", 10.0);
  return given;
}
inline ParamSet dynamics(const char* name, ParamSet given = {}) {
  given["dynamics"] = std::string(name);
  return with(std::move(given));
}

}  // namespace dismantle::sdf_penalty::test
