// Triangles and volumes seen along the axis: polygons and outlines in the plane.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "dismantle/tools/catalogue.h"

namespace dismantle::tools {

/// Range of directions as seen from the axis.
struct Directions {
  double middle = 0, half = 0;  // half >= pi: all
};

/// The part of a triangle between two heights, seen along the axis: a convex polygon, perhaps without area.
struct Piece {
  std::array<Eigen::Vector2d, 5> corner;
  std::size_t count = 0;
  double nearest = 0, farthest = 0;  // from the axis
  Directions directions{};
};

/// None: the triangle has no point between the heights.
std::optional<Piece> piece_of(const std::array<Eigen::Vector3d, 3>& triangle, double low, double high);

/// The piece turned about the axis; its directions are left.
Piece turned(const Piece& piece, const Eigen::Matrix2d& turn);

/// What is proved of a piece and an outline: it is farther than a margin from it, or it has a point inside that is
/// farther than the margin from the edge.
enum class Seen { clear, undecided, pierced };

/// A box or an obround seen along the axis.
struct Outline {
  const Volume* volume;
  double nearest, farthest;  // from the axis
  double half_width;
  Directions directions;

  explicit Outline(const Volume& v);
  /// Of a point from the outline; 0 inside.
  double distance_to(const Eigen::Vector2d& p) const;
  Seen look(const Piece& piece, double margin) const;
};

}  // namespace dismantle::tools
