/// Boxes of the parts of an assembly, made once.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/assembly.h"
#include "dismantle/mesh.h"
#include "dismantle/simulator.h"

namespace dismantle::geometry {

/// Half of the surface of a box, 0 for an empty one: how large a part is, be it a block, a plate or a frame.
inline double half_surface(const Aabb& box) {
  if (box.empty()) return 0;
  const Eigen::Vector3d s = box.size();
  return s.x() * s.y() + s.y() * s.z() + s.z() * s.x();
}

/// Boxes of all parts of one assembly.
class PartBoxes {
 public:
  explicit PartBoxes(const Assembly& assembly) {
    for (const Part& part : assembly.parts) {
      meshes_.push_back(part.mesh);
      boxes_.push_back(part.mesh->box());
      whole_.extend(boxes_.back());
    }
  }
  bool is_of(const Assembly& assembly) const {
    return std::equal(meshes_.begin(), meshes_.end(), assembly.parts.begin(), assembly.parts.end(),
                      [](const std::shared_ptr<const Mesh>& mesh, const Part& part) { return mesh == part.mesh; });
  }
  const std::vector<Aabb>& assembled() const { return boxes_; }  ///< by part
  double size() const {
    return whole_.empty() ? 0 : whole_.size().maxCoeff();
  }  ///< largest edge of the box of all parts

  /// Box along the axes of `frame` (its rows, in the world) around the box of a part.
  Aabb of(const PlacedPart& part, const Eigen::Matrix3d& frame = Eigen::Matrix3d::Identity()) const {
    const Aabb& box = boxes_.at(part.part);
    const Eigen::Matrix3d turn = frame * part.pose.q.toRotationMatrix();
    const Eigen::Vector3d center = turn * box.center() + frame * part.pose.t;
    const Eigen::Vector3d half = turn.cwiseAbs() * (0.5 * box.size());
    return {center - half, center + half};
  }
  /// The same around several parts.
  Aabb of(std::span<const PlacedPart> parts, const Eigen::Matrix3d& frame = Eigen::Matrix3d::Identity()) const {
    Aabb all;
    for (const PlacedPart& part : parts) all.extend(of(part, frame));
    return all;
  }

 private:
  std::vector<std::shared_ptr<const Mesh>> meshes_;
  std::vector<Aabb> boxes_;
  Aabb whole_;
};

/// Remembers what was made of the assembly that was asked about last. T(assembly) and T::is_of(assembly) are what it
/// needs.
template <class T>
class OfLastAssembly {
 public:
  std::shared_ptr<const T> of(const Assembly& assembly) const {
    const std::lock_guard lock(mutex_);
    if (!known_ || !known_->is_of(assembly)) known_ = std::make_shared<const T>(assembly);
    return known_;
  }

 private:
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const T> known_;
};

}  // namespace dismantle::geometry
