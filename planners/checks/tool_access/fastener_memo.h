/// What is known about the fasteners of one assembly, and kept between questions.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/fasteners/fastening.h"
#include "dismantle/fasteners/pattern.h"
#include "dismantle/fasteners/shape.h"
#include "dismantle/geometry/box_index.h"
#include "dismantle/geometry/congruent_parts.h"
#include "dismantle/simulator.h"
#include "dismantle/tools/access.h"

namespace dismantle::checks {

/// A screw, nut or circlip of the assembly, or a pin or bearing that is pressed in.
struct Driven {
  PartId part = 0;
  tools::Fastener fastener;  ///< as assembled
  std::string size;          ///< "M3x10"; empty: not known
  bool by_name = false;      ///< its shape alone does not say that it is a screw or a nut
  std::string unknown{};     ///< why its axis is not known, for people; empty: it is
  bool either_side = false;  ///< the tool comes from either end of the axis
  double height = 0;         ///< mm, along the axis, of what the tool may come to from either end
  bool pressed = false;      ///< without play in, or on, each of its partners
  bool sure = true;          ///< false: it may as well be drawn with its size, so that only facets overlap
  /// Parts beside its thread, or inside its hole, the nearest one first: it is driven into one of them, or onto it.
  std::vector<PartId> partners{};
};

/// What blocks the use of a tool, by part that is there.
class BlockedBy {
 public:
  BlockedBy() = default;
  BlockedBy(BlockedBy&&) = default;
  BlockedBy& operator=(BlockedBy&&) = default;
  std::span<const tools::Arcs* const> arcs() const { return arcs_; }
  /// Another answer for the part at this place among those that are there.
  void replace(std::size_t index, const tools::Arcs& arcs) { arcs_[index] = &arcs; }

 private:
  friend class FastenerMemo;
  std::shared_ptr<const void> kept_;
  std::vector<tools::Arcs> moved_;
  std::vector<const tools::Arcs*> arcs_;
};

/// Thread-safe. The assembly must outlive it.
class FastenerMemo {
 public:
  explicit FastenerMemo(const Assembly& assembly);

  bool is_of(const Assembly& assembly) const;
  const Assembly& assembly() const { return assembly_; }
  /// None: the part is nothing that a tool drives.
  const Driven* driven(PartId part) const;
  /// The fastener as it is driven into `partner`, or onto it: a nut travels along what stands out of it.
  tools::Fastener driven_by(const Driven& driven, std::optional<PartId> partner, bool flipped) const;

  /// What the screws of the assembly do; found at the first call. None: the part is no screw, or nothing is known.
  const fasteners::Fastening* fastening_of(PartId screw) const;
  /// The pattern that a screw belongs to; null: none.
  const fasteners::Pattern* pattern_of(PartId screw) const;
  /// The screw that is driven into this nut, or none.
  std::optional<PartId> screw_in(PartId nut) const;
  /// The nut that this screw is driven into, or none: one that turns, not one in a slot.
  std::optional<PartId> nut_of(PartId screw) const;
  /// The part in which a nut, or a head with corners, cannot turn. `at`: `driven` is there.
  std::optional<PartId> kept_by(const Driven& driven, std::span<const PlacedPart> there, const Pose& at) const;

  /// What is in the way of the use of a tool, in the order of `there`. `fastener` is as assembled; `pose` takes it to
  /// where it is. `place`: number of the use in its catalogue.
  BlockedBy blocked(const Driven& driven, const tools::Fastener& fastener, bool flipped, const tools::Use& use,
                    std::size_t place, std::span<const PlacedPart> there, const Pose& pose, bool hand) const;
  /// What is in the way if `part`, which is in its place, is turned about its own axis by k times 10 degrees, for k
  /// from 1 to 35. Empty: it has no such axis. The arguments as for blocked().
  std::span<const tools::Arcs> turned(const Driven& driven, const tools::Fastener& fastener, bool flipped,
                                      const tools::Use& use, std::size_t place, PartId part, bool hand) const;
  /// Where the use of a tool has room past it. Ids of parts are in Access::in_the_way.
  static tools::Access room(const tools::Fastener& fastener, const tools::Use& use, const BlockedBy& blocked,
                            std::span<const PlacedPart> there, const Pose& pose);

 private:
  using Key = std::tuple<PartId, bool, double, std::size_t, bool>;  // part, flipped, travel, place, hand
  struct Row {
    std::vector<std::once_flag> once;
    std::vector<tools::Arcs> arcs;
    explicit Row(std::size_t parts) : once(parts), arcs(parts) {}
  };
  const TriangleBvh& surface(PartId part) const;
  /// Looked at once for all parts of one shape.
  fasteners::Shape shape_of(PartId part) const;
  std::optional<Driven> look_at(const Part& part) const;
  void find_fastenings() const;
  bool driven_by_thread(PartId part) const;
  std::optional<Driven> pressed_in(const Part& part, const fasteners::Shape& shape, const PartKind& said) const;
  void find_partners(Driven& driven, const fasteners::Shape& shape) const;

  const Assembly& assembly_;
  std::vector<std::shared_ptr<const Mesh>> meshes_;
  geometry::BoxIndex boxes_;
  double mm_;
  std::vector<geometry::ShapePlacement> placements_;
  mutable std::vector<std::once_flag> surface_once_, driven_once_, shape_once_;
  mutable std::vector<std::unique_ptr<TriangleBvh>> surfaces_;
  mutable std::vector<std::optional<Driven>> driven_;
  mutable std::vector<fasteners::Shape> shapes_;  // by original
  mutable std::once_flag fastenings_once_;
  mutable std::vector<fasteners::Fastening> fastenings_;
  mutable std::vector<fasteners::Pattern> patterns_;
  mutable std::vector<std::optional<std::size_t>> fastening_of_, pattern_of_;  // by screw
  mutable std::vector<std::optional<PartId>> screw_in_, nut_of_;               // by nut, by screw
  mutable std::mutex mutex_;
  mutable std::map<Key, std::shared_ptr<Row>> rows_;
  mutable std::map<std::pair<Key, PartId>, std::vector<tools::Arcs>> turned_;
};

}  // namespace dismantle::checks
