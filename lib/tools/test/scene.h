// Scenes around a screw for tests: known tools, blocks at any pose, in any unit.
#pragma once

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "dismantle/testing/shapes.h"
#include "dismantle/tools/access.h"

namespace dismantle::tools::test {

using Vec3 = Eigen::Vector3d;

inline Volume tube(double radius, double low, double high, double inner = 0) {
  Volume v;
  v.low = low, v.high = high, v.inner = inner, v.radius = radius;
  return v;
}
inline Volume box(Eigen::Vector2d from, Eigen::Vector2d to, double low, double high) {
  Volume v;
  v.form = Form::box, v.low = low, v.high = high, v.from = from, v.to = to;
  return v;
}
inline Volume obround(Eigen::Vector2d from, Eigen::Vector2d to, double radius, double low, double high) {
  Volume v = box(from, to, low, high);
  v.form = Form::obround, v.radius = radius;
  return v;
}

/// Parts around a fastener whose top is the origin and whose axis is z, in millimetres; then all of it at a pose and in
/// a unit of `mm` millimetres.
class Scene {
 public:
  Scene(const std::vector<Mesh>& parts, Fastener fastener, const Pose& pose = {}, double mm = 1) : fastener_(fastener) {
    fastener_.top = pose * fastener.top / mm;
    fastener_.axis = pose.q * fastener.axis;
    fastener_.mm = mm;
    for (Mesh part : parts) {
      for (Vec3& p : part.vertices) p = pose * p / mm;
      surfaces_.push_back(std::make_unique<TriangleBvh>(part));
    }
    for (const auto& surface : surfaces_) obstacles_.push_back({surface.get()});
  }
  const Fastener& fastener() const { return fastener_; }
  const std::vector<Obstacle>& obstacles() const { return obstacles_; }
  Access find(const Tool& tool, bool hand = true) const { return find_access(tool, fastener_, obstacles_, hand); }

 private:
  Fastener fastener_;
  std::vector<std::unique_ptr<TriangleBvh>> surfaces_;
  std::vector<Obstacle> obstacles_;
};

inline const Tool& tool_named(const std::string& id) {
  for (const Tool& tool : standard_catalogue())
    if (tool.id == id) return tool;
  throw std::runtime_error("no tool " + id);
}

/// M3 with a hexagon socket of 2.5, 10 mm long.
inline Fastener m3() {
  Fastener f;
  f.drive = fasteners::Drive::hex_socket;
  f.size = 2.5, f.grip = 3, f.radius = 2.75, f.travel = 1;
  return f;
}
/// M6 nut, across flats 10.
inline Fastener m6_nut() {
  Fastener f;
  f.kind = fasteners::Kind::nut;
  f.drive = fasteners::Drive::outer_hex;
  f.size = 10, f.grip = 5.2, f.radius = 5.8, f.travel = 5.2;
  return f;
}

}  // namespace dismantle::tools::test
