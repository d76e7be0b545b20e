/// Writes pictures as PNG and paints them on a page, with cairo.
#pragma once

#include <cairo.h>

#include <cstdint>
#include <vector>

#include "illustrator.h"

namespace dismantle {

/// @throws Error naming `doing` when cairo reports one.
void check_cairo(cairo_status_t status, const char* doing);

/// Paints the picture with its lines at (x, y), `scale` units of the page per pixel.
void paint_picture(cairo_t* page, const Picture& picture, double x, double y, double scale);

/// Deterministic for given versions of cairo and zlib.
std::vector<std::uint8_t> png_of(const Picture& picture);

}  // namespace dismantle
