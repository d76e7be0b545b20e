/// The container of binary glTF 2.0: the buffer with its views and accessors, and the file around it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <vector>

namespace dismantle {

using GlbJson = nlohmann::ordered_json;

enum GlbComponent { kUint16 = 5123, kUint32 = 5125, kFloat = 5126 };
enum GlbTarget { kNone = 0, kVertices = 34962, kIndices = 34963 };

/// Collects the buffer, its views and accessors.
class GlbBuffer {
 public:
  /// `count` elements of type `type` from `data`. Returns the accessor's index.
  template <class Scalar>
  std::size_t add(const std::vector<Scalar>& data, GlbComponent component, const char* type, std::size_t count,
                  GlbTarget target, bool bounds) {
    bytes_.resize((bytes_.size() + 3) & ~std::size_t{3});
    const std::size_t offset = bytes_.size(), length = data.size() * sizeof(Scalar);
    bytes_.resize(offset + length);
    std::memcpy(bytes_.data() + offset, data.data(), length);
    GlbJson view = {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", length}};
    if (target != kNone) view["target"] = static_cast<int>(target);
    GlbJson accessor = {{"bufferView", views_.size()},
                        {"componentType", static_cast<int>(component)},
                        {"count", count},
                        {"type", type}};
    if (bounds) {
      const std::size_t width = data.size() / count;
      std::vector<Scalar> lo(data.begin(), data.begin() + static_cast<std::ptrdiff_t>(width)), hi = lo;
      for (std::size_t i = 0; i < data.size(); ++i) {
        lo[i % width] = std::min(lo[i % width], data[i]);
        hi[i % width] = std::max(hi[i % width], data[i]);
      }
      accessor["min"] = lo;
      accessor["max"] = hi;
    }
    views_.push_back(std::move(view));
    accessors_.push_back(std::move(accessor));
    return accessors_.size() - 1;
  }

  const std::vector<std::uint8_t>& bytes() const { return bytes_; }
  const GlbJson& views() const { return views_; }
  const GlbJson& accessors() const { return accessors_; }

 private:
  std::vector<std::uint8_t> bytes_;
  GlbJson views_ = GlbJson::array(), accessors_ = GlbJson::array();
};

/// The bytes of a .glb file of `json` and the buffer's. @throws Error when it would be larger than 4 GB.
std::vector<std::uint8_t> pack_glb(const GlbJson& json, std::vector<std::uint8_t> binary);

}  // namespace dismantle
