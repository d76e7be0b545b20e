#include "gif.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "dismantle/errors.h"
#ifdef DISMANTLE_GIF
#include <gif_lib.h>
#endif

namespace dismantle {
namespace {

/// Red, green, blue of a premultiplied pixel on white.
std::array<std::uint8_t, 3> on_white(std::uint32_t p) {
  const std::uint32_t white = 255 - (p >> 24);
  const auto channel = [&](int shift) {
    return static_cast<std::uint8_t>(std::min(255u, ((p >> shift) & 255u) + white));
  };
  return {channel(16), channel(8), channel(0)};
}

std::uint32_t bin_of(const std::array<std::uint8_t, 3>& c) {
  return (c[0] >> 3u) << 10u | (c[1] >> 3u) << 5u | (c[2] >> 3u);
}

}  // namespace

void GifPalette::count(const Image& image) {
  for (const std::uint32_t pixel : image.pixels) {
    const auto colour = on_white(pixel);
    Bin& bin = bins_[bin_of(colour)];
    ++bin.pixels;
    for (std::size_t k = 0; k < 3; ++k) bin.sum[k] += colour[k];
  }
}

GifColours GifPalette::colours() const {
  std::vector<const Bin*> all;
  for (const auto& [key, bin] : bins_) all.push_back(&bin);
  std::ranges::stable_sort(all, std::greater{}, &Bin::pixels);
  GifColours out;
  for (std::size_t i = 0; i < all.size() && i < 256; ++i) {
    std::array<std::uint8_t, 3> colour{};
    for (std::size_t k = 0; k < 3; ++k) colour[k] = static_cast<std::uint8_t>(all[i]->sum[k] / all[i]->pixels);
    out.push_back(colour);
  }
  return out;
}

std::uint8_t GifWriter::nearest(std::uint32_t pixel) {
  const auto colour = on_white(pixel);
  std::int16_t& known = known_[bin_of(colour)];
  if (known < 0) {
    int least = std::numeric_limits<int>::max();
    for (std::size_t i = 0; i < colours_.size(); ++i) {
      int distance = 0;
      for (std::size_t k = 0; k < 3; ++k) distance += (colour[k] - colours_[i][k]) * (colour[k] - colours_[i][k]);
      if (distance < least) least = distance, known = static_cast<std::int16_t>(i);
    }
  }
  return static_cast<std::uint8_t>(known);
}

#ifdef DISMANTLE_GIF
namespace {

int append_gif(GifFileType* file, const GifByteType* data, int length) {
  static_cast<std::string*>(file->UserData)
      ->append(reinterpret_cast<const char*>(data), static_cast<std::size_t>(length));
  return length;
}

void check_gif(int result) {
  if (result != GIF_OK) throw Error("giflib cannot write the picture");
}

}  // namespace

GifWriter::GifWriter(int width, int height, GifColours colours)
    : width_(width), height_(height), colours_(std::move(colours)), known_(1u << 15u, -1) {
  int error = 0;
  GifFileType* file = EGifOpen(&bytes_, append_gif, &error);
  if (file == nullptr) throw Error("giflib cannot begin a picture");
  file_ = file;
  std::vector<GifColorType> map(256);
  for (std::size_t i = 0; i < colours_.size(); ++i) map[i] = {colours_[i][0], colours_[i][1], colours_[i][2]};
  ColorMapObject* object = GifMakeMapObject(256, map.data());
  EGifSetGifVersion(file, true);
  const int put = EGifPutScreenDesc(file, width, height, 8, 0, object);
  GifFreeMapObject(object);
  check_gif(put);
  check_gif(EGifPutExtensionLeader(file, APPLICATION_EXT_FUNC_CODE));
  check_gif(EGifPutExtensionBlock(file, 11, "NETSCAPE2.0"));
  const unsigned char for_ever[] = {1, 0, 0};
  check_gif(EGifPutExtensionBlock(file, 3, for_ever));
  check_gif(EGifPutExtensionTrailer(file));
}

GifWriter::~GifWriter() {
  int error = 0;
  if (file_ != nullptr) EGifCloseFile(static_cast<GifFileType*>(file_), &error);
}

void GifWriter::add(const Image& image, int time) {
  auto* file = static_cast<GifFileType*>(file_);
  std::vector<std::uint8_t> now(image.pixels.size());
  std::ranges::transform(image.pixels, now.begin(), [this](std::uint32_t p) { return nearest(p); });
  int left = 0, top = 0, right = width_ - 1, bottom = height_ - 1;
  if (!before_.empty()) {
    const auto same = [&](int x, int y) {
      const std::size_t i = static_cast<std::size_t>(y) * width_ + x;
      return now[i] == before_[i];
    };
    const auto row = [&](int y) {
      for (int x = 0; x < width_; ++x)
        if (!same(x, y)) return false;
      return true;
    };
    const auto column = [&](int x) {
      for (int y = top; y <= bottom; ++y)
        if (!same(x, y)) return false;
      return true;
    };
    while (top < bottom && row(top)) ++top;
    while (bottom > top && row(bottom)) --bottom;
    while (left < right && column(left)) ++left;
    while (right > left && column(right)) --right;
  }
  GraphicsControlBlock control{DISPOSE_DO_NOT, false, time, NO_TRANSPARENT_COLOR};
  GifByteType block[4];
  EGifGCBToExtension(&control, block);
  check_gif(EGifPutExtension(file, GRAPHICS_EXT_FUNC_CODE, 4, block));
  const int width = right - left + 1;
  check_gif(EGifPutImageDesc(file, left, top, width, bottom - top + 1, false, nullptr));
  for (int y = top; y <= bottom; ++y)
    check_gif(EGifPutLine(file, &now[static_cast<std::size_t>(y) * width_ + left], width));
  before_ = std::move(now);
}

std::string GifWriter::finish() {
  int error = 0;
  const int closed = EGifCloseFile(static_cast<GifFileType*>(std::exchange(file_, nullptr)), &error);
  check_gif(closed);
  return std::move(bytes_);
}
#else
GifWriter::GifWriter(int width, int height, GifColours colours)
    : width_(width), height_(height), colours_(std::move(colours)) {
  throw Error("this program was built without GIF; install libgif-dev and build again");
}
GifWriter::~GifWriter() = default;
void GifWriter::add(const Image&, int) {}
std::string GifWriter::finish() { return std::move(bytes_); }
#endif

}  // namespace dismantle
