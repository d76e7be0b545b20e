/// Divides a box of poses into cells until the assembled pose is cut off from its border. The box grows where the parts
/// turn out to move further.
#pragma once

#include <cstdint>

#include "configuration_cells/active_samples.h"
#include "configuration_cells/configuration_cells.h"
#include "configuration_cells/decomposition_record.h"
#include "configuration_cells/free_space_sampler.h"
#include "configuration_cells/pose_cell.h"
#include "configuration_cells/search_box.h"
#include "dismantle/executor.h"
#include "dismantle/immobility/cell_graph.h"
#include "dismantle/run_context.h"

namespace dismantle::immobility {

class CellDecomposition {
 public:
  enum class End {
    closed,  ///< no chain of cells leads from the assembled pose to the border
    open,    ///< a chain that cannot be divided leads there; or the parts move beyond the limits; or told to stop
    spent,   ///< no divisions are left
  };

  struct Scale {
    double max_shift;  ///< parts that move further count as separable; assembly units
    double tolerance;  ///< the unit of the lengths of the parameters; assembly units
  };

  /// The first box contains the poses of the sampler, and the samples that blocked it are active. Further samples are
  /// activated as needed, and the sampler is directed to where cells lead.
  CellDecomposition(const SampledPair& pair, FreeSpaceSampler& sampler, const ConfigurationCellsParameters& params,
                    const Scale& scale, ForkJoin& fork_join);

  End run(const RunContext& context);
  /// After `closed`: the content of the certificate.
  DecompositionProof proof(std::uint32_t solids_of_a) const {
    return record_.proof(pair_, solids_of_a, box_.lo(), box_.hi());
  }
  /// After `closed`: bounds of the component of the assembled pose.
  const PoseCell& bounds() const { return bounds_; }

 private:
  struct Cell : PoseCell {
    NearSamples near;
    bool tested = false;  ///< all samples were tested at the centre
  };

  Cell first_cell();
  CellStatus status(const PoseCell& cell) const;
  double extent(const PoseCell& cell) const;
  std::uint32_t to_divide(std::uint32_t exit) const;
  void activate_along(std::uint32_t exit);
  std::uint32_t blocked_at(std::uint32_t exit) const;
  SearchBox::Sides sides_reached(std::uint32_t exit) const;
  void grow(const SearchBox::Sides& sides);
  bool turns_freely(std::size_t checks, const RunContext& context);
  bool beyond_limits() const;
  bool closed();
  void divide(std::uint32_t node);

  const SampledPair& pair_;
  FreeSpaceSampler& sampler_;
  const ConfigurationCellsParameters& params_;
  Scale limits_;
  ForkJoin& fork_join_;
  ActiveSamples active_;
  Vector6 scale_;
  SearchBox box_;
  DecompositionRecord record_;
  CellGraph<Cell> cells_;
  PoseCell bounds_;
  std::size_t sent_at_ = 0,
              pause_;  ///< last round with an extension of the sampler, and rounds until the next
};

}  // namespace dismantle::immobility
