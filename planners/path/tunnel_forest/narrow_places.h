/// Places where a body is thin or nearly touches itself. Such places meet in the narrow passages of a puzzle.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <vector>

#include "dismantle/mesh.h"
#include "dismantle/pose.h"
#include "dismantle/run_context.h"

namespace dismantle::tunnel_forest {

/// A chord from the surface, along its normal, to a surface that faces it.
struct NarrowPlace {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< unit vector along the chord
  double half_width = 0;                            ///< assembly units
};

struct NarrowPlaces {
  std::vector<NarrowPlace> gaps;  ///< chords outside the material
  std::vector<NarrowPlace> bars;  ///< chords inside
};

/// Chords at `samples` points drawn uniformly from the surface, in the frame of the mesh. `mesh` must be closed.
NarrowPlaces find_narrow_places(const Mesh& mesh, std::size_t samples, Rng& rng);

/// Draws displacements that bring a narrow place of the moving body to one of the fixed body: gap into gap, bar into
/// gap, gap around bar. Only gaps that are narrow compared with the other body's bars count.
class TunnelPoses {
 public:
  /// `width`: the widest gap that counts, in median bar widths of the other body.
  TunnelPoses(NarrowPlaces moving, NarrowPlaces fixed, double width);
  bool empty() const { return kinds_.empty(); }

  struct Match {
    Pose displacement;          ///< of the moving body
    Eigen::Vector3d on_moving;  ///< before the displacement
    Eigen::Vector3d on_fixed;   ///< displacement * on_moving
    double reach = 0;           ///< largest distance between the two points that is still within the tunnel
  };
  /// Requires !empty().
  Match draw(Rng& rng, bool turning = true) const;

 private:
  enum class Kind { gap_in_gap, bar_in_gap, gap_on_bar };
  NarrowPlaces moving_, fixed_;
  std::vector<Kind> kinds_;
};

/// Uniform in SO(3) (Shoemake 1992).
Eigen::Quaterniond random_turn(Rng& rng);

}  // namespace dismantle::tunnel_forest
