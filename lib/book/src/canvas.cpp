#include "canvas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "dismantle/errors.h"

namespace dismantle {
namespace {

struct CairoDeleter {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_t* context) const { cairo_destroy(context); }
};

/// Draws `points` as a line with an arrow head, first in white, then in colour, to be visible on any background.
void stroke_arrow(cairo_t* page, const std::vector<Eigen::Vector2d>& points, double thick) {
  double length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  if (length < 6 * thick) return;  // the motion is along the line of sight, or too short
  const double tip_length = 13 * thick;
  const Eigen::Vector2d tip = points.back();
  std::size_t before = points.size() - 1;  // point that gives the direction of the head
  while (before > 0 && (tip - points[before]).norm() < tip_length) --before;
  const Eigen::Vector2d along = (tip - points[before]).normalized(), across(-along.y(), along.x());
  const auto line = [&] {
    cairo_new_path(page);
    for (std::size_t i = 0; i <= before; ++i) cairo_line_to(page, points[i].x(), points[i].y());
    const Eigen::Vector2d end = tip - 0.8 * tip_length * along;
    cairo_line_to(page, end.x(), end.y());
  };
  const auto head = [&](double grown) {
    const Eigen::Vector2d front = tip + grown * along, back = tip - (tip_length + grown) * along;
    const Eigen::Vector2d a = back + (0.42 * tip_length + grown) * across,
                          b = back - (0.42 * tip_length + grown) * across;
    cairo_new_path(page);
    cairo_move_to(page, front.x(), front.y());
    cairo_line_to(page, a.x(), a.y());
    cairo_line_to(page, b.x(), b.y());
    cairo_close_path(page);
    cairo_fill(page);
  };
  cairo_set_line_cap(page, CAIRO_LINE_CAP_ROUND);
  cairo_set_line_join(page, CAIRO_LINE_JOIN_ROUND);
  cairo_set_source_rgba(page, 1, 1, 1, 0.85);
  cairo_set_line_width(page, 5 * thick);
  line();
  cairo_stroke(page);
  head(2 * thick);
  cairo_set_source_rgb(page, 0.80, 0.11, 0.11);
  const double dashes[] = {7 * thick, 5 * thick};
  cairo_set_dash(page, dashes, 2, 0);
  cairo_set_line_width(page, 2.2 * thick);
  line();
  cairo_stroke(page);
  cairo_set_dash(page, nullptr, 0, 0);
  head(0);
}

cairo_status_t append(void* bytes, const unsigned char* data, unsigned length) {
  auto& out = *static_cast<std::vector<std::uint8_t>*>(bytes);
  out.insert(out.end(), data, data + length);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

void check_cairo(cairo_status_t status, const char* doing) {
  if (status != CAIRO_STATUS_SUCCESS) throw Error(fmt::format("{}: {}", doing, cairo_status_to_string(status)));
}

void paint_picture(cairo_t* page, const Picture& picture, double x, double y, double scale) {
  const Image& image = picture.image;
  const std::unique_ptr<cairo_surface_t, CairoDeleter> surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, image.width, image.height));
  check_cairo(cairo_surface_status(surface.get()), "a picture");
  cairo_surface_flush(surface.get());
  unsigned char* data = cairo_image_surface_get_data(surface.get());
  const int stride = cairo_image_surface_get_stride(surface.get());
  // On white, without transparency: files are half as large and faster to write.
  for (int row = 0; row < image.height; ++row) {
    auto* line = reinterpret_cast<std::uint32_t*>(data + static_cast<std::ptrdiff_t>(row) * stride);
    for (int column = 0; column < image.width; ++column) {
      const std::uint32_t p = image.pixels[static_cast<std::size_t>(row) * image.width + column];
      line[column] = p + (255 - (p >> 24)) * 0x010101u;
    }
  }
  cairo_surface_mark_dirty(surface.get());
  cairo_save(page);
  cairo_translate(page, x, y);
  cairo_scale(page, scale, scale);
  cairo_set_source_surface(page, surface.get(), 0, 0);
  cairo_rectangle(page, 0, 0, image.width, image.height);
  cairo_fill(page);
  cairo_rectangle(page, 0, 0, image.width, image.height);
  cairo_clip(page);
  const double thick = std::max(0.75, image.width / double(PictureStyle{}.step.width));
  for (const auto& arrow : picture.arrows) stroke_arrow(page, arrow, thick);
  for (const auto& [middle, radius] : picture.rings) {
    cairo_set_source_rgb(page, 0.80, 0.11, 0.11);
    cairo_set_line_width(page, 1.8 * thick);
    cairo_new_path(page);
    cairo_arc(page, middle.x(), middle.y(), radius, 0, 2 * std::numbers::pi);
    cairo_stroke(page);
  }
  cairo_restore(page);
}

std::vector<std::uint8_t> png_of(const Picture& picture) {
  const std::unique_ptr<cairo_surface_t, CairoDeleter> surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, picture.image.width, picture.image.height));
  const std::unique_ptr<cairo_t, CairoDeleter> context(cairo_create(surface.get()));
  paint_picture(context.get(), picture, 0, 0, 1);
  check_cairo(cairo_status(context.get()), "a picture");
  std::vector<std::uint8_t> out;
  check_cairo(cairo_surface_write_to_png_stream(surface.get(), append, &out), "a picture as PNG");
  return out;
}

}  // namespace dismantle
