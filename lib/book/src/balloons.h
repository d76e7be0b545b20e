/// Numbers in circles beside a picture, each with a line to the part that it stands for.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "raster.h"

namespace dismantle {

struct Balloon {
  std::size_t number = 0;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();      ///< point of the part, pixels
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();  ///< of the circle, pixels
  bool held = false;                                 ///< a part to hold
};

/// Radius of the circles, pixels, in a picture of this width.
double balloon_radius(int width);

/// Finds a place for each circle: on as little of the drawing as possible, near its point, apart from other circles,
/// with lines that do not cross. Those without a place are left out.
std::vector<Balloon> placed_balloons(std::vector<Balloon> wanted, const Image& image);

}  // namespace dismantle
