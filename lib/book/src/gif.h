/// Writes animated GIFs.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "raster.h"

namespace dismantle {

using GifColours = std::vector<std::array<std::uint8_t, 3>>;

/// The most frequent colours of some pictures, on white.
class GifPalette {
 public:
  void count(const Image& image);
  /// At most 256.
  GifColours colours() const;

 private:
  struct Bin {
    std::uint64_t pixels = 0;
    std::array<std::uint64_t, 3> sum{};
  };
  std::map<std::uint32_t, Bin> bins_;
};

/// One file, pictures of one size. Pictures are drawn in the nearest colours; only what changes is written.
class GifWriter {
 public:
  /// @throws Error when the program was built without giflib.
  GifWriter(int width, int height, GifColours colours);
  ~GifWriter();
  GifWriter(const GifWriter&) = delete;
  GifWriter& operator=(const GifWriter&) = delete;

  /// `time`: how long it is shown, 1/100 s.
  void add(const Image& image, int time);
  std::string finish();

 private:
  std::uint8_t nearest(std::uint32_t pixel);

  int width_, height_;
  GifColours colours_;
  std::vector<std::int16_t> known_;   // by colour in 5 bits each; -1: not looked for yet
  std::vector<std::uint8_t> before_;  // the last picture
  std::string bytes_;
  void* file_ = nullptr;  // GifFileType
};

}  // namespace dismantle
