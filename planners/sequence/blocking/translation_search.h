/// Search over the arrangements of all parts of a group: translations of one part, or of as many as it takes along,
/// until some part or group is free. For burrs and sliding puzzles, where no part is free as assembled.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "blocking/params.h"
#include "blocking/polyhedron.h"
#include "dismantle/assembly.h"
#include "dismantle/run_context.h"

namespace dismantle::blocking {

/// Parts move along a direction together, by the same length.
struct Translation {
  std::vector<PartId> parts;  ///< ascending
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
  double length = 0;  ///< assembly units; infinite: they leave
};

/// The places of parts are translations of the assembled ones.
using Places = std::map<PartId, Eigen::Vector3d>;

/// A state is one translation per part. From it, any part may move along any direction that faces of the parts suggest,
/// to the next place where a face of it is flush with one of another part, or (when that is not enough) where it meets
/// one; parts that it would run into are taken along. Where faces are flush openings are open, and translations that
/// stop nowhere else are sums of such ones. Breadth first, so with the fewest such steps. Shapes are those of the
/// parts, thinner by a share of the tolerance; the verifier has to confirm what is found.
class TranslationSearch {
 public:
  /// `tolerance`: of the verifier, assembly units. All references must outlive this.
  TranslationSearch(const Assembly& assembly, double tolerance, const PartialTranslationParams& params);

  enum class End { found, exhausted, limit, too_long, stopped, unsuited };
  struct Answer {
    End end = End::unsuited;
    std::vector<Translation> translations;  ///< the last has infinite length
    std::size_t states = 0;
  };
  /// Up to `most_states`, and (too_long) as long as the lengths that had to be measured for it took no more than
  /// `most_work` pairs of edges. What was measured stays known, so asking again with more work resumes. Unsuited: some
  /// shapes are not made of flat faces, or overlap.
  Answer search(const Places& places, std::size_t most_states, double most_work, const RunContext& context);
  /// From now on `moving` at these places cannot go along that direction past `fixed`: the verifier refused it.
  void forbid(PartId moving, PartId fixed, const Eigen::Vector3d& offset, const Eigen::Vector3d& direction);

 private:
  struct Shape {
    Polyhedron body;
    std::vector<std::vector<double>> planes;  ///< by direction: offsets of the faces that look along it, ascending
  };
  Answer search(const Places& places, std::size_t most_states, bool to_contact, const RunContext& context);
  double gap() const;
  std::int64_t grid(double x) const;
  std::vector<std::int64_t> key_of_places(const std::vector<Eigen::Vector3d>& at) const;
  bool is_simple(const Polyhedron& body) const;
  const Shape& shape(PartId part);
  double free_distance(PartId moving, PartId fixed, const Eigen::Vector3d& offset, std::size_t direction);
  bool prepare(const Places& places);

  struct Key {
    std::uint64_t pair;
    std::int64_t x, y, z;
    bool operator==(const Key&) const = default;
  };
  struct Hash {
    std::size_t operator()(const Key& k) const;
  };
  Key key_of(PartId moving, PartId fixed, const Eigen::Vector3d& offset, std::size_t direction, double& sign) const;

  const Assembly& assembly_;
  double tolerance_;
  const PartialTranslationParams& params_;
  std::map<PartId, Shape> shapes_;
  std::vector<Eigen::Vector3d> directions_;  ///< in opposite pairs
  std::unordered_map<Key, double, Hash> free_;
  double work_ = 0, most_work_ = 0;  ///< of the search in hand
};

}  // namespace dismantle::blocking
