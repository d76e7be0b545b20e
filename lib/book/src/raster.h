/// Draws triangle meshes with shaded faces and edge lines: a software z-buffer.
///
/// No library is used because the same plan must give the same bytes on every machine, with and without a display. VTK
/// in Debian needs an X server. Pictures of OpenGL (OSMesa, EGL) depend on the machine's driver, and Mesa has removed
/// OSMesa (25.1).
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
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< point at the centre of the picture
  double scale = 1;                                  ///< pixels per unit of length

  /// Pixels from the left and the top edge, and the height above the target towards the viewer in pixels.
  Eigen::Vector3d project(const Eigen::Vector3d& point, int width, int height) const {
    const Eigen::Vector3d v = scale * (axes * (point - target));
    return {0.5 * width + v.x(), 0.5 * height - v.y(), v.z()};
  }
};

struct DrawnBody {
  const ShadedMesh* mesh = nullptr;
  Pose pose;               ///< pose at which the mesh is drawn
  Eigen::Vector3f colour;  ///< sRGB, [0, 1]
  bool marked = false;     ///< drawn translucently through bodies in front of it
};

/// Premultiplied ARGB in native byte order (cairo's ARGB32), `width` per row. The background is transparent.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint32_t> pixels;
};

/// Draws edges where the part, the depth or the normal is discontinuous.
Image draw(const std::vector<DrawnBody>& bodies, const Camera& camera, int width, int height,
           const LineStyle& style = {});

/// Where a body is seen.
struct Sight {
  std::size_t pixels = 0;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  ///< the pixel of it that is nearest to the middle of all
};
/// By body. None of it is hidden by others if `pixels` is that of the body alone.
std::vector<Sight> sights(const std::vector<DrawnBody>& bodies, const Camera& camera, int width, int height);

/// Number of pixels in which a marked body is the front one. Smaller pictures are faster.
std::size_t visible_pixels(const std::vector<DrawnBody>& bodies, const Camera& camera, int width, int height);

}  // namespace dismantle
