// Allowed depth of the parts of a pair in each other.
#include <algorithm>

#include "dismantle/sdf/contact_scene.h"

namespace dismantle::sdf {

float ContactScene::assembled_depth(const ContactPair& pair, const Member& owner, const Member& surface,
                                    const Eigen::Vector3d& point) const {
  const Eigen::Vector3d p = surface.placed->rest.inverse() * (owner.placed->rest * point);
  double depth = 0;
  for (const SolidField& s : surface.placed->shape->solids)
    if (s.box.contains(p) && s.grid->lower_bound(p) <= 0) depth = std::max(depth, -s.surface->sample(p).value);
  depth += std::min(0.5 * depth, depths_.slack) + depths_.threshold;
  return depth > pair.everywhere ? static_cast<float>(std::min(depth, pair.allowed)) : 0.0F;
}

void ContactScene::measure_own_depths(const ContactPair& pair, DirectedContacts& set, const Member& owner,
                                      const Member& surface) const {
  const ContactPoints& points = owner.placed->shape->points;
  const Pose to_surface = surface.placed->rest.inverse() * owner.placed->rest;
  set.own.assign(points.points.size(), 0.0F);
  for (const PointBlock& block : points.blocks) {
    if (surface.placed->shape->box.squared_distance(to_surface * block.center) > block.radius * block.radius) continue;
    for (std::uint32_t i = block.first; i < block.first + block.count; ++i)
      set.own[i] = assembled_depth(pair, owner, surface, points.points[i]);
  }
}

bool ContactScene::overlap_is_local() const {
  return std::any_of(pairs_.begin(), pairs_.end(), [](const ContactPair& p) { return p.everywhere < p.allowed; });
}

void ContactScene::allow_overlap_everywhere() {
  rest_ = nullptr;
  for (auto& pair : pairs_) {
    pair.everywhere = pair.allowed;
    // Cached linear regions kept a smaller distance from edges.
    for (DirectedContacts* set : {&pair.ab, &pair.ba}) {
      std::fill(set->linear.begin(), set->linear.end(), 0U);
      set->known.clear();
    }
  }
}

}  // namespace dismantle::sdf
