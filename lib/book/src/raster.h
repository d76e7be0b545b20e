/// Line drawings with shaded faces of triangle meshes: a z-buffer in software.
///
/// Why not a library: the same plan has to give the same bytes on every machine, with and without a display. VTK in
/// Debian draws through an X server; what OpenGL draws (OSMesa, EGL) depends on the driver that the machine has, and
/// Mesa has given OSMesa up (25.1).
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "dismantle/plan_io/shading.h"
#include "dismantle/pose.h"
#include "style.h"

namespace dismantle {

/// Orthographic. Rows of `axes`: right, up, towards the viewer; unit vectors.
struct Camera {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< is in the middle of the picture
  double scale = 1;                                  ///< pixels per unit of length

  /// Pixels from the left and the top edge, and the height above the target towards the viewer in pixels.
  Eigen::Vector3d project(const Eigen::Vector3d& point, int width, int height) const {
    const Eigen::Vector3d v = scale * (axes * (point - target));
    return {0.5 * width + v.x(), 0.5 * height - v.y(), v.z()};
  }
};

struct DrawnBody {
  const ShadedMesh* mesh = nullptr;
  Pose pose;               ///< takes the mesh to where it is drawn
  Eigen::Vector3f colour;  ///< sRGB, [0, 1]
  bool marked = false;     ///< shimmers through what is before it
};

/// Premultiplied ARGB in native byte order (cairo's ARGB32), `width` per row. Transparent where nothing is.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint32_t> pixels;
};

/// Edges are drawn where parts, depths or normals break.
Image draw(const std::vector<DrawnBody>& bodies, const Camera& camera, int width, int height,
           const LineStyle& style = {});

/// Pixels in which a marked body is the front one. Coarser pictures answer faster.
std::size_t visible_pixels(const std::vector<DrawnBody>& bodies, const Camera& camera, int width, int height);

}  // namespace dismantle
