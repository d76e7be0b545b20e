/// The lengths that samples and distance fields have in common.
#pragma once

namespace dismantle::tolerant_walk {

/// All of them follow from one: the edge of a cell of the distance fields, in assembly units.
struct Resolution {
  double cell = 0.01;

  /// Smallest distance of samples: fields change little over a few cells.
  double sample_spacing() const { return 3 * cell; }
  /// Parts that are this near to each other when assembled are sampled densely there.
  double near() const { return 2 * sample_spacing(); }
  /// Largest radius of the balls that stand for thin walls. Thicker walls are seen by the edges of the other part.
  double thin_radius() const { return 8 * cell; }
  /// Width of the band around a part where its field is known. Wider than thin_radius(), which is the largest distance
  /// that a sample has to keep.
  double band() const { return 10 * cell; }
  /// Beyond this distance from the surface the coarse grid is precise enough.
  double coarse_distance() const { return 12 * cell; }
  /// Samples this near to a refused one become stricter together with it.
  double neighborhood() const { return 5 * cell; }
  /// Least step of a ray through a field, and margin for its error.
  double ray_step() const { return cell / 5; }
  /// A ray that is this near to the surface has reached it.
  double on_surface() const { return cell / 20; }
};

}  // namespace dismantle::tolerant_walk
