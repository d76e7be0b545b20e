#include "raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace dismantle {
namespace {

/// Depth, body and normal of the front surface at each sample.
struct Layer {
  int width, height;
  std::vector<float> depth;
  std::vector<std::int32_t> body;  // -1: none
  std::vector<Eigen::Vector3f> normal;

  Layer(int w, int h)
      : width(w),
        height(h),
        depth(static_cast<std::size_t>(w) * h, -std::numeric_limits<float>::infinity()),
        body(depth.size(), -1),
        normal(depth.size(), Eigen::Vector3f::Zero()) {}
  std::size_t at(int x, int y) const { return static_cast<std::size_t>(y) * width + x; }
};

void fill(Layer& layer, const std::array<Eigen::Vector3d, 3>& p, const std::array<Eigen::Vector3f, 3>& n,
          std::int32_t body) {
  const double area = (p[1].x() - p[0].x()) * (p[2].y() - p[0].y()) - (p[1].y() - p[0].y()) * (p[2].x() - p[0].x());
  if (!(area < 0)) return;  // seen from behind (y points down), or from the side
  const auto [left, right] = std::minmax({p[0].x(), p[1].x(), p[2].x()});
  const auto [top, bottom] = std::minmax({p[0].y(), p[1].y(), p[2].y()});
  const auto clipped = [](double v, int end) {
    return static_cast<int>(std::clamp(v, -1.0, static_cast<double>(end)));
  };
  const int x0 = std::max(0, clipped(std::ceil(left - 0.5), layer.width));
  const int x1 = std::min(layer.width - 1, clipped(std::floor(right - 0.5), layer.width));
  const int y0 = std::max(0, clipped(std::ceil(top - 0.5), layer.height));
  const int y1 = std::min(layer.height - 1, clipped(std::floor(bottom - 0.5), layer.height));
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      const double px = x + 0.5, py = y + 0.5;
      double w[3];
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d &a = p[(k + 1) % 3], &b = p[(k + 2) % 3];
        w[k] = ((b.x() - a.x()) * (py - a.y()) - (b.y() - a.y()) * (px - a.x())) / area;
      }
      if (w[0] < 0 || w[1] < 0 || w[2] < 0) continue;
      const auto z = static_cast<float>(w[0] * p[0].z() + w[1] * p[1].z() + w[2] * p[2].z());
      const std::size_t at = layer.at(x, y);
      if (z <= layer.depth[at]) continue;
      layer.depth[at] = z;
      layer.body[at] = body;
      layer.normal[at] = float(w[0]) * n[0] + float(w[1]) * n[1] + float(w[2]) * n[2];
    }
}

/// `all` or the marked bodies only. Normals in the camera's axes.
Layer render(const std::vector<DrawnBody>& bodies, const Camera& camera, int width, int height, bool all) {
  Layer layer(width, height);
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3f> normals;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const DrawnBody& body = bodies[b];
    if (!all && !body.marked) continue;
    const Eigen::Matrix3f turn = (camera.axes * body.pose.q.toRotationMatrix()).cast<float>();
    points.clear();
    normals.clear();
    for (const auto& v : body.mesh->positions)
      points.push_back(camera.project(body.pose * v.cast<double>(), width, height));
    for (const auto& n : body.mesh->normals) normals.push_back(turn * n);
    const auto& indices = body.mesh->indices;
    for (std::size_t t = 0; t + 2 < indices.size(); t += 3)
      fill(layer, {points[indices[t]], points[indices[t + 1]], points[indices[t + 2]]},
           {normals[indices[t]], normals[indices[t + 1]], normals[indices[t + 2]]}, static_cast<std::int32_t>(b));
  }
  return layer;
}

/// Opacity of the line between two neighbouring samples, 0 for none.
float edge_between(const Layer& layer, std::size_t a, std::size_t b, int axis, float distance, const LineStyle& style) {
  if (layer.body[a] != layer.body[b]) return style.outline;
  if (layer.body[a] < 0) return 0;
  const Eigen::Vector3f &m = layer.normal[a], &n = layer.normal[b];
  // Change of depth if the surface continues according to its normal.
  const auto slope = [&](const Eigen::Vector3f& v) {
    return (axis == 0 ? -v.x() : v.y()) / std::max(v.z(), 0.05f) * distance;
  };
  const float jump = std::abs(layer.depth[b] - layer.depth[a]);
  if (jump > 6 * distance + 2 * std::max(std::abs(slope(m)), std::abs(slope(n)))) return style.outline;
  return m.normalized().dot(n.normalized()) < style.crease_cosine ? style.crease : 0;
}

float line_at(const Layer& layer, int x, int y, const LineStyle& style) {
  float dark = 0;
  const std::size_t here = layer.at(x, y);
  for (int d = 1; d <= 2; ++d) {
    if (x + d < layer.width) dark = std::max(dark, edge_between(layer, here, layer.at(x + d, y), 0, float(d), style));
    if (y + d < layer.height) dark = std::max(dark, edge_between(layer, here, layer.at(x, y + d), 1, float(d), style));
  }
  return dark;
}

Eigen::Vector3f lit(const Eigen::Vector3f& colour, const Eigen::Vector3f& normal) {
  static const Eigen::Vector3f key = Eigen::Vector3f(-0.55f, 0.65f, 0.52f).normalized();
  static const Eigen::Vector3f filling = Eigen::Vector3f(0.8f, 0.1f, 0.6f).normalized();
  const Eigen::Vector3f n = normal.normalized();
  const float light = 0.56f + 0.44f * std::max(0.0f, n.dot(key)) + 0.05f * std::max(0.0f, n.dot(filling));
  return (light * colour).cwiseMin(1.0f);
}

}  // namespace

Image draw(const std::vector<DrawnBody>& bodies, const Camera& camera, int width, int height, const LineStyle& style) {
  Camera fine = camera;
  fine.scale *= style.samples;
  const Layer front = render(bodies, fine, width * style.samples, height * style.samples, true);
  const Layer marked = render(bodies, fine, width * style.samples, height * style.samples, false);
  const Eigen::Vector3f& ink = style.ink;

  Image out{width, height, std::vector<std::uint32_t>(static_cast<std::size_t>(width) * height)};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      Eigen::Vector4f sum = Eigen::Vector4f::Zero();  // premultiplied
      for (int s = 0; s < style.samples * style.samples; ++s) {
        const int sx = x * style.samples + s % style.samples, sy = y * style.samples + s / style.samples;
        const std::size_t at = front.at(sx, sy);
        Eigen::Vector3f rgb = ink;
        float alpha = 0;
        const auto over = [&](const Eigen::Vector3f& colour, float opacity) {
          rgb = alpha > 0 ? Eigen::Vector3f(rgb + opacity * (colour - rgb)) : colour;
          alpha += (1 - alpha) * opacity;
        };
        if (const std::int32_t b = front.body[at]; b >= 0)
          over(lit(bodies[static_cast<std::size_t>(b)].colour, front.normal[at]), 1);
        if (const float line = line_at(front, sx, sy, style); line > 0) over(ink, line);
        if (const std::int32_t b = marked.body[at]; front.body[at] >= 0 && front.body[at] != b) {
          const bool hidden = b >= 0;
          if (hidden) over(bodies[static_cast<std::size_t>(b)].colour, style.shimmer);
          if (line_at(marked, sx, sy, style) > 0 &&
              (hidden || !bodies[static_cast<std::size_t>(front.body[at])].marked))
            over(hidden ? bodies[static_cast<std::size_t>(b)].colour * 0.6f : ink, style.crease);
        }
        sum += Eigen::Vector4f(alpha * rgb.x(), alpha * rgb.y(), alpha * rgb.z(), alpha);
      }
      std::uint32_t word = 0;
      for (const int channel : {3, 0, 1, 2})
        word = word << 8 | static_cast<std::uint32_t>(
                               std::lround(255 * std::clamp(sum[channel] / (style.samples * style.samples), 0.f, 1.f)));
      out.pixels[static_cast<std::size_t>(y) * width + x] = word;
    }
  return out;
}

std::vector<Sight> sights(const std::vector<DrawnBody>& bodies, const Camera& camera, int width, int height) {
  const Layer front = render(bodies, camera, width, height, true);
  std::vector<Sight> out(bodies.size());
  std::vector<Eigen::Vector2d> sum(bodies.size(), Eigen::Vector2d::Zero());
  std::vector<double> least(bodies.size(), std::numeric_limits<double>::infinity());
  const auto each = [&](auto&& f) {
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        if (const std::int32_t b = front.body[front.at(x, y)]; b >= 0)
          f(static_cast<std::size_t>(b), Eigen::Vector2d(x + 0.5, y + 0.5));
  };
  each([&](std::size_t b, const Eigen::Vector2d& p) {
    ++out[b].pixels;
    sum[b] += p;
  });
  each([&](std::size_t b, const Eigen::Vector2d& p) {
    const double distance = (p - sum[b] / double(out[b].pixels)).squaredNorm();
    if (distance < least[b]) least[b] = distance, out[b].at = p;
  });
  return out;
}

std::size_t visible_pixels(const std::vector<DrawnBody>& bodies, const Camera& camera, int width, int height) {
  const Layer front = render(bodies, camera, width, height, true);
  return static_cast<std::size_t>(std::ranges::count_if(
      front.body, [&](std::int32_t b) { return b >= 0 && bodies[static_cast<std::size_t>(b)].marked; }));
}

}  // namespace dismantle
