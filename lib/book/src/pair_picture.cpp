// Two parts and the place where they overlap.
#include <algorithm>

#include "canvas.h"
#include "dismantle/book/book.h"

namespace dismantle {
Picture Illustrator::pair(PartId other, PartId marked, const Eigen::Vector3d& at) const {
  const auto [width, height] = style_.step;
  const PlacedPart seen{marked, Pose{}};
  const Eigen::Matrix3d axes = axes_of(Viewpoint{});
  std::vector<Eigen::Vector3d> points = corners({seen});
  points.push_back(at);
  const Camera camera = camera_for(points, axes, width, height);
  Picture picture;
  picture.image = draw({body_of({other, Pose{}}, false), body_of(seen, true)}, camera, width, height, style_.lines);
  picture.rings.emplace_back(camera.project(at, width, height).head<2>(), style_.ring * width);
  return picture;
}

std::string pair_png(const Assembly& assembly, PartId other, PartId marked, const Eigen::Vector3d& at,
                     const Eigen::Vector3d& up) {
  Assembly two = assembly;
  two.parts = {assembly.parts.at(other), assembly.parts.at(marked)};
  const std::vector<std::uint8_t> png = png_of(Illustrator(two, up).pair(0, 1, at));
  return {png.begin(), png.end()};
}

}  // namespace dismantle
