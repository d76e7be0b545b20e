/// What searches have computed of parts, for the next ones.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <mutex>

#include "dismantle/mesh.h"
#include "dismantle/pose.h"
#include "dismantle/tolerant_walk/probes.h"
#include "dismantle/tolerant_walk/solid_field.h"

namespace dismantle::tolerant_walk {

/// Fields of parts, and probes of pairs as they stand. They follow from the meshes alone, so no answer depends on what
/// is kept. Parts with one mesh share its field. Safe to use from several threads.
class GeometryCache {
 public:
  /// About so many bytes are kept; when it is more, everything is computed anew.
  explicit GeometryCache(std::size_t most_bytes = std::size_t{512} << 20) : most_bytes_(most_bytes) {}

  /// The one that all planners of this process share, plugins of different files too; it lives as long as one of them
  /// holds it.
  static std::shared_ptr<GeometryCache> shared();

  /// What probes of one mesh against another depend on; or those against whatever comes.
  struct Pair {
    Pair(const Mesh& of, const Allowance& allowance);
    Pair(const Mesh& of, const Mesh& other, const Pose& place, const Allowance& allowance, double excused_within);
    auto operator<=>(const Pair&) const = default;

   private:
    std::array<const Mesh*, 2> meshes_;
    std::array<double, 10> numbers_;
    bool exactly_;
  };

  /// Between searches: makes room where too much is kept. What is in use stays with those who use it.
  void make_room();
  std::shared_ptr<SolidField> field(const std::shared_ptr<const Mesh>& mesh);
  /// `make` is called where they are not known, from this thread, and may use the cache. Both meshes have fields here.
  std::shared_ptr<const Probes> probes(const Pair& pair, const std::function<Probes()>& make);
  std::size_t bytes() const;  ///< about so many are kept

 private:
  std::size_t bytes_under_lock() const;

  const std::size_t most_bytes_;
  mutable std::mutex mutex_;
  std::map<const Mesh*, std::shared_ptr<SolidField>> fields_;  // which keep the meshes
  std::map<Pair, std::shared_ptr<const Probes>> probes_;
};

}  // namespace dismantle::tolerant_walk
