#include "simulator.h"

#include <algorithm>
#include <limits>
#include <mutex>
#include <set>

#include "dismantle/errors.h"
#include "dismantle/executor.h"
#include "dismantle/geometry/congruence.h"
#include "world.h"

namespace dismantle::mesh_collision {
std::shared_ptr<const PreparedAssembly> FclSimulator::prepare(const Assembly& assembly, double /*tolerance*/,
                                                              RunContext& context) {
  auto prepared = std::make_shared<PreparedBodies>();
  const std::size_t n = assembly.parts.size();
  prepared->placed.resize(n);
  std::vector<std::size_t> model(n), distinct;
  for (std::size_t i = 0; i < n; ++i) {
    model[i] = i;
    // Parts that agree within single precision share a shape.
    const double same = std::numeric_limits<float>::epsilon() * assembly.parts[i].mesh->box().size().norm();
    for (const std::size_t d : distinct)
      if (const auto pose = geometry::congruence(*assembly.parts[d].mesh, *assembly.parts[i].mesh, same)) {
        model[i] = d;
        prepared->placed[i].rest = *pose;
        break;
      }
    if (model[i] == i) distinct.push_back(i);
  }
  // Parts that overlap when assembled need copies shrunken by that much more.
  std::vector<std::set<double>> depths(n);
  for (std::size_t i = 0; i < n && parameters_.certified_depth > 0; ++i)
    depths[model[i]].insert(parameters_.certified_depth);
  for (const auto& o : assembly.overlaps) {
    const double depth = o.allowed();
    prepared->overlaps[{o.a, o.b}] = depth;
    if (parameters_.certified_depth > 0)
      for (const PartId p : {o.a, o.b}) depths[model[p]].insert(depth + parameters_.certified_depth);
  }
  std::mutex progress;
  std::size_t done = 0;
  parallel_for(
      distinct.size(), context,
      [&](std::size_t k) {
        const std::size_t i = distinct[k];
        const std::vector<double> shrunken_by(depths[i].begin(), depths[i].end());
        prepared->placed[i].body = make_body(assembly.parts[i], shrunken_by);
        const std::lock_guard lock(progress);
        context.progress("hierarchies", ++done, distinct.size(), assembly.parts[i].name);
      },
      [&] { return context.should_stop(); });
  for (std::size_t i = 0; i < n; ++i) prepared->placed[i].body = prepared->placed[model[i]].body;
  return prepared;
}

std::unique_ptr<World> FclSimulator::world(const Assembly& assembly, const PreparedAssembly& prepared,
                                           const Scene& scene, MotionSpace space) const {
  const auto& bodies = dynamic_cast<const PreparedBodies&>(prepared);
  for (const auto* group : {&scene.moving, &scene.fixed})
    for (const PlacedPart& p : *group)
      if (p.part >= bodies.placed.size() || !bodies.placed[p.part].body)
        throw InputError(
            p.part < assembly.parts.size() ? assembly.parts[p.part].name : "part " + std::to_string(p.part),
            "was not prepared (the preparation was interrupted)");
  return std::make_unique<MeshWorld>(bodies, scene, space, parameters_);
}

}  // namespace dismantle::mesh_collision
