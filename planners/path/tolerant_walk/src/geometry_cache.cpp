#include "dismantle/tolerant_walk/geometry_cache.h"

namespace dismantle::tolerant_walk {
namespace {

constexpr double kCell = 0.01;  // assembly units: of the fields

}  // namespace

GeometryCache::Pair::Pair(const Mesh& of, const Mesh& other, const Pose& place, const Allowance& allowance,
                          double excused_within)
    : meshes_{&of, &other},
      numbers_{place.q.w(), place.q.x(), place.q.y(),       place.q.z(),      place.t.x(),
               place.t.y(), place.t.z(), allowance.overlap, allowance.beyond, excused_within},
      exactly_(allowance.exactly) {}

GeometryCache::Pair::Pair(const Mesh& of, const Allowance& allowance) : Pair(of, of, Pose{}, allowance, 0) {
  meshes_[1] = nullptr;
}

void GeometryCache::make_room() {
  if (bytes() <= most_bytes_) return;
  probes_.clear();
  fields_.clear();
}

std::shared_ptr<SolidField> GeometryCache::field(const std::shared_ptr<const Mesh>& mesh) {
  auto& known = fields_[mesh.get()];
  if (!known) known = std::make_shared<SolidField>(mesh, kCell);
  return known;
}

const Probes& GeometryCache::probes(const Pair& pair, const std::function<Probes()>& make) {
  const auto known = probes_.find(pair);
  return known != probes_.end() ? known->second : probes_.emplace(pair, make()).first->second;
}

std::size_t GeometryCache::bytes() const {
  std::size_t sum = 0;
  for (const auto& [mesh, field] : fields_) sum += field->bytes();
  for (const auto& [pair, probes] : probes_) sum += probes.bytes();
  return sum;
}

}  // namespace dismantle::tolerant_walk
