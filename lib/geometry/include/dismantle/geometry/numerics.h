/// Numerical tolerances that several files share. They decide about rounding, never about how hard something is tried.
#pragma once

#include <cstdint>

namespace dismantle::geometry {

/// Relative error that a chain of a few dozen operations in double precision stays below, with a margin of about 1e5:
/// coordinates are products of rotations, and corners of slivers lose digits. Of a length: times the size of the
/// coordinates that it is computed from.
inline constexpr double kRounding = 1e-9;

/// Cosine between unit vectors that count as one direction: 0.26 degrees. Normals that come from single precision files
/// differ by up to about 0.1 degrees on the small triangles of a flat face.
inline constexpr double kSameDirection = 0.99999;

/// Index that refers to nothing: no neighbour, no parent, no owner.
inline constexpr std::uint32_t kNoIndex = 0xffffffffu;

}  // namespace dismantle::geometry
