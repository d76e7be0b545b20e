/// What fastens what: what a screw clamps, and what it is driven into.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/export.h"
#include "dismantle/fasteners/shape.h"
#include "dismantle/run_context.h"

namespace dismantle {
class TriangleBvh;
}

namespace dismantle::fasteners {

/// What is wrong with a screw in its place, or worth a look.
enum class FasteningProblem {
  nut_missing,  ///< it goes through all parts with play and sticks out, and there is no thread
  other_size,   ///< its nut has another thread
  too_short,    ///< its tip does not reach the thread, or not far enough
  on_ground,    ///< its tip stands on the ground of its hole
};

/// A problem with what it is about.
struct FasteningFault {
  FasteningProblem problem = FasteningProblem::nut_missing;
  std::optional<PartId> other{};  ///< the nut, or the part with the thread
};

/// What geometry says of one screw. What it does not say is left empty.
struct Fastening {
  PartId screw = 0;
  std::vector<PartId> clamps{};  ///< from the head to the thread, washers too; empty: nothing, or not known
  std::vector<PartId> into{};    ///< what has the thread, nearest to the head first; empty: not known
  /// If `into` is empty: the last part whose bore has no play. Another bore may be the thread as well.
  std::optional<PartId> possible_thread{};
  bool nut = false;            ///< `into` begins with nuts, inserts or stand-offs, not with a part that is threaded
  std::vector<PartId> only{};  ///< of `clamps`, those that no other screw clamps or is driven into
  std::vector<FasteningFault> faults{};
};

/// The surface of a part; may be called from several threads.
using SurfaceOf = std::function<const TriangleBvh&(PartId)>;

/// Of all parts that are screws by shape, and by Part::kind where it is set; in the order of the parts. `shapes`: of
/// all parts. A part is threaded where its bore is narrower than the screw's thread, clamped where its bore is wider
/// and it lies without gap between the head and the thread. @throws Error when `context` wants to stop.
DISMANTLE_API std::vector<Fastening> fastenings_of(const Assembly& assembly, std::span<const Shape> shapes,
                                                   const SurfaceOf& surface, const RunContext& context);

/// A nut on the thread of a part that is no screw.
struct NutOnRod {
  PartId nut = 0, rod = 0;
};
/// Nuts, by Part::kind, that are not on a screw of `fastenings` and whose hole another part fills.
DISMANTLE_API std::vector<NutOnRod> nuts_on_rods(const Assembly& assembly, std::span<const Shape> shapes,
                                                 std::span<const Fastening> fastenings, const SurfaceOf& surface);

/// "clamps 'lid' to 'housing'; driven into 'housing'; no other screw holds 'lid'". Empty: nothing is known.
DISMANTLE_API std::string fastening_text(const Assembly& assembly, const Fastening& fastening);
/// One sentence, without a full stop.
DISMANTLE_API std::string fault_text(const Assembly& assembly, const Fastening& fastening, const FasteningFault& fault);

}  // namespace dismantle::fasteners
