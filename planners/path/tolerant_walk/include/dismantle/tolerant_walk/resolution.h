/// Lengths shared by samples and distance fields.
#pragma once

namespace dismantle::tolerant_walk {

/// All lengths follow from the cell edge of the distance fields, in assembly units.
struct Resolution {
  double cell = 0.01;

  /// Smallest distance between samples: fields change little over a few cells.
  double sample_spacing() const { return 3 * cell; }
  /// Parts are sampled densely where they are this near to each other when assembled.
  double near() const { return 2 * sample_spacing(); }
  /// Largest radius of the medial balls that detect thin walls. Samples on the other part's edges detect thicker walls.
  double thin_radius() const { return 8 * cell; }
  /// Width of the band around a part where its field is known. Must exceed thin_radius(), the largest distance that a
  /// sample has to keep.
  double band() const { return 10 * cell; }
  /// Beyond this distance from the surface the coarse grid is precise enough.
  double coarse_distance() const { return 12 * cell; }
  /// A refused sample makes the samples within this distance stricter, too.
  double neighborhood() const { return 5 * cell; }
  /// Smallest step of a ray through a field, and margin for the field's error.
  double ray_step() const { return cell / 5; }
  /// A ray has reached the surface when it is this near to it.
  double on_surface() const { return cell / 20; }
};

}  // namespace dismantle::tolerant_walk
