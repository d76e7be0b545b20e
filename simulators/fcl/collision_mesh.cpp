#include "collision_mesh.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>

#include <stdexcept>

namespace dismantle::mesh_collision {
namespace {

fcl::Transform3d transform(const Pose& pose) {
  fcl::Transform3d t = fcl::Transform3d::Identity();
  t.linear() = pose.q.toRotationMatrix();
  t.translation() = pose.t;
  return t;
}

}  // namespace

struct CollisionMesh::Impl {
  fcl::BVHModel<fcl::OBBRSSd> model;
};

CollisionMesh::CollisionMesh(const std::vector<Eigen::Vector3d>& vertices, const std::vector<Triangle>& triangles)
    : impl_(std::make_unique<Impl>()) {
  if (triangles.empty()) throw std::invalid_argument("a collision mesh needs triangles");
  std::vector<fcl::Triangle> indices;
  indices.reserve(triangles.size());
  for (const auto& t : triangles) indices.emplace_back(t[0], t[1], t[2]);
  impl_->model.beginModel(static_cast<int>(triangles.size()), static_cast<int>(vertices.size()));
  impl_->model.addSubModel(vertices, indices);
  if (impl_->model.endModel() != fcl::BVH_OK) throw std::runtime_error("FCL could not build a hierarchy");
  impl_->model.computeLocalAABB();
}

CollisionMesh::~CollisionMesh() = default;
CollisionMesh::CollisionMesh(CollisionMesh&&) noexcept = default;
CollisionMesh& CollisionMesh::operator=(CollisionMesh&&) noexcept = default;

struct Collider::Impl {
  fcl::CollisionRequestd request;
  fcl::CollisionResultd result;
};

Collider::Collider() : impl_(std::make_unique<Impl>()) {}
Collider::~Collider() = default;

bool Collider::meet(const CollisionMesh& a, const Pose& pose_a, const CollisionMesh& b, const Pose& pose_b) {
  impl_->request.num_max_contacts = 1;
  impl_->result.clear();
  return fcl::collide(&a.impl().model, transform(pose_a), &b.impl().model, transform(pose_b), impl_->request,
                      impl_->result) > 0;
}

void Collider::pairs(const CollisionMesh& a, const Pose& pose_a, const CollisionMesh& b, const Pose& pose_b,
                     std::size_t limit, std::vector<TrianglePair>& out) {
  impl_->request.num_max_contacts = limit;
  impl_->result.clear();
  fcl::collide(&a.impl().model, transform(pose_a), &b.impl().model, transform(pose_b), impl_->request, impl_->result);
  out.clear();
  for (std::size_t i = 0; i < impl_->result.numContacts(); ++i) {
    const auto& contact = impl_->result.getContact(i);
    out.push_back({static_cast<std::uint32_t>(contact.b1), static_cast<std::uint32_t>(contact.b2)});
  }
}

}  // namespace dismantle::mesh_collision
