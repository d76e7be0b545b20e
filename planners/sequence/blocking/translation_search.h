/// Search over the arrangements of all parts of a group. One part at a time is translated, with the parts that it takes
/// along, until a part or group is free. For burrs and sliding puzzles, where no part is free when assembled.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "blocking/parameters.h"
#include "blocking/polyhedron.h"
#include "dismantle/assembly.h"
#include "dismantle/run_context.h"

namespace dismantle::blocking {

/// A translation of several parts along one direction by the same length.
struct Translation {
  std::vector<PartId> parts;  ///< ascending
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
  double length = 0;  ///< assembly units; infinite: the parts leave
};

/// The place of each part, as a translation from its assembled position.
using Places = std::map<PartId, Eigen::Vector3d>;

/// A state is one translation per part. From a state, any part may move along any direction that the faces of the parts
/// suggest, to the next place where one of its faces is flush with a face of another part, or (if that does not
/// suffice) where it meets another part. Parts that it would run into are taken along. Openings are passable where
/// faces are flush, and other translations are sums of such steps. Breadth first finds the fewest steps. The shapes are
/// the parts, thinner by a share of the tolerance, so the verifier has to confirm every result.
class TranslationSearch {
 public:
  /// `tolerance`: of the verifier, assembly units. All references must outlive this.
  TranslationSearch(const Assembly& assembly, double tolerance, const PartialTranslationParameters& params);

  enum class End { found, exhausted, limit, too_long, stopped, unsuited };
  struct Answer {
    End end = End::unsuited;
    std::vector<Translation> translations;  ///< the last has infinite length
    std::size_t states = 0;                 ///< visited
    std::size_t waiting = 0;                ///< found and not visited
    std::size_t moves = 0;                  ///< of one part along one direction, from any state: parts times directions
    /// The work was used up before as many states were visited as may follow the first one: the parts are so detailed
    /// that a few times as much would not reach far, either.
    bool hopeless() const { return end == End::too_long && states <= moves; }
  };
  /// Visits up to `most_states` states (else `limit`) and compares up to `most_work` pairs of edges or faces (else
  /// `too_long`). Measured lengths are cached, so a later search with more work resumes. `unsuited`: more than 64
  /// parts, or a part with more than `translation_edges` edges.
  Answer search(const Places& places, std::size_t most_states, double most_work, const RunContext& context);
  /// Records that the verifier refused to let `moving`, at `offset` from `fixed`, pass `fixed` along `direction`.
  void forbid(PartId moving, PartId fixed, const Eigen::Vector3d& offset, const Eigen::Vector3d& direction);

 private:
  struct Shape {
    Polyhedron body;
    std::vector<std::vector<double>> planes;  ///< by direction: offsets of the faces with this normal, ascending
  };
  class Arrangements;
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
  const PartialTranslationParameters& params_;
  std::map<PartId, Shape> shapes_;
  std::vector<Eigen::Vector3d> directions_;  ///< in opposite pairs
  std::unordered_map<Key, double, Hash> free_;
  double work_ = 0, most_work_ = 0;  ///< of the current search
};

}  // namespace dismantle::blocking
