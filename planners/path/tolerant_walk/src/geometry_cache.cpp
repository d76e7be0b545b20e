#include "dismantle/tolerant_walk/geometry_cache.h"

#include <utility>

namespace dismantle::tolerant_walk {

std::shared_ptr<GeometryCache> GeometryCache::shared() {
  static std::mutex mutex;
  static std::weak_ptr<GeometryCache> known;
  const std::scoped_lock lock(mutex);
  std::shared_ptr<GeometryCache> cache = known.lock();
  if (cache == nullptr) known = cache = std::make_shared<GeometryCache>();
  return cache;
}

GeometryCache::Pair::Pair(const Mesh& of, const Mesh& other, const Pose& place, const Sampling& sampling,
                          const Allowance& allowance)
    : meshes_{&of, &other},
      numbers_{place.q.w(),
               place.q.x(),
               place.q.y(),
               place.q.z(),
               place.t.x(),
               place.t.y(),
               place.t.z(),
               sampling.resolution.cell,
               static_cast<double>(sampling.max_samples),
               allowance.overlap,
               allowance.tolerance} {}

GeometryCache::Pair::Pair(const Mesh& of, const Sampling& sampling, const Allowance& allowance)
    : Pair(of, of, Pose{}, sampling, allowance) {
  meshes_[1] = nullptr;
}

void GeometryCache::make_room() {
  const std::scoped_lock lock(mutex_);
  if (bytes_under_lock() <= most_bytes_) return;
  probes_.clear();
  fields_.clear();
}

std::shared_ptr<DistanceField> GeometryCache::field(const std::shared_ptr<const Mesh>& mesh,
                                                    const Resolution& resolution) {
  const std::scoped_lock lock(mutex_);
  auto& known = fields_[{mesh.get(), resolution.cell}];
  if (!known) known = std::make_shared<DistanceField>(mesh, resolution);
  return known;
}

std::shared_ptr<const Probes> GeometryCache::probes(const Pair& pair, const std::function<Probes()>& make) {
  {
    const std::scoped_lock lock(mutex_);
    if (const auto known = probes_.find(pair); known != probes_.end()) return known->second;
  }
  auto made = std::make_shared<const Probes>(make());
  const std::scoped_lock lock(mutex_);
  return probes_.try_emplace(pair, std::move(made)).first->second;  // another thread may have been first
}

std::size_t GeometryCache::bytes() const {
  const std::scoped_lock lock(mutex_);
  return bytes_under_lock();
}

std::size_t GeometryCache::bytes_under_lock() const {
  std::size_t sum = 0;
  for (const auto& [mesh, field] : fields_) sum += field->bytes();
  for (const auto& [pair, probes] : probes_) sum += probes->bytes();
  return sum;
}

}  // namespace dismantle::tolerant_walk
