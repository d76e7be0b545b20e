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
#include "dismantle/fasteners/shape.h"
#include "dismantle/simulator.h"
#include "dismantle/tools/access.h"

namespace dismantle::checks {

/// A screw, nut or circlip of the assembly.
struct Driven {
  PartId part = 0;
  tools::Fastener fastener;  ///< as assembled
  std::string size;          ///< "M3x10"; empty: not known
  bool either_side = false;  ///< the tool comes from either end of the axis
  /// Parts beside its thread, or inside its hole, the nearest one first: it is driven into one of them, or onto it.
  std::vector<PartId> partners{};
};

/// Thread-safe. The assembly must outlive it.
class FastenerMemo {
 public:
  explicit FastenerMemo(const Assembly& assembly);

  bool is_of(const Assembly& assembly) const;
  const Assembly& assembly() const { return assembly_; }
  /// None: the part is no fastener that a tool drives.
  const Driven* driven(PartId part) const;
  /// The fastener as it is driven into `partner`, or onto it: a nut travels along what stands out of it.
  tools::Fastener driven_by(const Driven& driven, std::optional<PartId> partner, bool flipped) const;

  /// Where the use of a tool has room past the parts that are there. Ids of parts are in Access::in_the_way. `fastener`
  /// is as assembled; `pose` takes it to where it is. `place`: number of the use in its catalogue.
  tools::Access room(const Driven& driven, const tools::Fastener& fastener, bool flipped, const tools::Use& use,
                     std::size_t place, std::span<const PlacedPart> there, const Pose& pose, bool hand) const;

 private:
  using Key = std::tuple<PartId, bool, double, std::size_t, bool>;  // part, flipped, travel, place, hand
  struct Row {
    std::vector<std::once_flag> once;
    std::vector<tools::Arcs> arcs;
    explicit Row(std::size_t parts) : once(parts), arcs(parts) {}
  };
  const TriangleBvh& surface(PartId part) const;
  std::optional<Driven> look_at(const Part& part) const;
  void find_partners(Driven& driven, const fasteners::Shape& shape) const;

  const Assembly& assembly_;
  std::vector<std::shared_ptr<const Mesh>> meshes_;
  double mm_;
  mutable std::vector<std::once_flag> surface_once_, driven_once_;
  mutable std::vector<std::unique_ptr<TriangleBvh>> surfaces_;
  mutable std::vector<std::optional<Driven>> driven_;
  mutable std::mutex mutex_;
  mutable std::map<Key, std::shared_ptr<Row>> rows_;
};

}  // namespace dismantle::checks
