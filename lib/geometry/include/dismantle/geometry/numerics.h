/// Numerical tolerances that several files share. They bound rounding errors and never limit effort.
#pragma once

#include <cstdint>

namespace dismantle::geometry {

/// Bound of the relative error of a few dozen operations in double precision, with a margin of about 1e5 because
/// coordinates are products of rotations and corners of slivers lose digits. For a length, multiply it by the size of
/// the coordinates that the length is computed from.
inline constexpr double kRounding = 1e-9;

/// Cosine of 0.26 degrees: unit vectors closer than that count as one direction. Normals from single precision files
/// differ by up to about 0.1 degrees on small triangles of a flat face.
inline constexpr double kSameDirection = 0.99999;

/// Index that refers to nothing: no neighbour, no parent, no owner.
inline constexpr std::uint32_t kNoIndex = 0xffffffffu;

}  // namespace dismantle::geometry
