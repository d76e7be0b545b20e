/// Fields and probes that searches have computed, kept for later searches.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "dismantle/mesh.h"
#include "dismantle/pose.h"
#include "dismantle/tolerant_walk/distance_field.h"
#include "dismantle/tolerant_walk/probes.h"

namespace dismantle::tolerant_walk {

/// How densely surfaces are sampled.
struct Sampling {
  Resolution resolution;
  std::size_t max_samples = 5'000;  ///< of a part near another one; a fifth as many on its whole surface
};

/// Distance fields of parts, and probes of pairs at their poses. The keys determine them, so results do not depend on
/// the content of the cache. Parts with the same mesh share a field. Thread-safe.
class GeometryCache {
 public:
  /// make_room() drops everything once more than about `most_bytes` are cached.
  explicit GeometryCache(std::size_t most_bytes = std::size_t{512} << 20) : most_bytes_(most_bytes) {}

  /// The cache that all planners of a plugin library share. It is deleted with its last holder.
  static std::shared_ptr<GeometryCache> shared();

  /// Everything that the probes of one mesh against another, or against any other, depend on.
  struct Pair {
    Pair(const Mesh& of, const Sampling& sampling, const Allowance& allowance);
    Pair(const Mesh& of, const Mesh& other, const Pose& place, const Sampling& sampling, const Allowance& allowance);
    auto operator<=>(const Pair&) const = default;

   private:
    std::array<const Mesh*, 2> meshes_;
    std::array<double, 11> numbers_;
  };

  /// Call it between searches. Objects in use stay alive with their owners.
  void make_room();
  std::shared_ptr<DistanceField> field(const std::shared_ptr<const Mesh>& mesh, const Resolution& resolution);
  /// Calls `make` in this thread if the probes are not cached; `make` may use the cache. Both meshes need a field in
  /// the cache, which keeps them alive.
  std::shared_ptr<const Probes> probes(const Pair& pair, const std::function<Probes()>& make);
  std::size_t bytes() const;  ///< approximate

 private:
  std::size_t bytes_under_lock() const;

  const std::size_t most_bytes_;
  mutable std::mutex mutex_;
  std::map<std::pair<const Mesh*, double>, std::shared_ptr<DistanceField>> fields_;  // by mesh and cell
  std::map<Pair, std::shared_ptr<const Probes>> probes_;
};

}  // namespace dismantle::tolerant_walk
