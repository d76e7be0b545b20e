#include "gltf_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "dismantle/errors.h"
#include "dismantle/referenced_file.h"
#include "gltf_container.h"
#include "input_limits.h"

namespace dismantle::mesh_files {
namespace {

using Json = nlohmann::json;

/// Component types of accessors.
enum : std::size_t { kByte = 5120, kUByte = 5121, kShort = 5122, kUShort = 5123, kUInt = 5125, kFloat = 5126 };

std::size_t size_of(std::size_t type) {
  return type == kByte || type == kUByte ? 1 : type == kShort || type == kUShort ? 2 : 4;
}

double number(const char* bytes, std::size_t type, bool normalized) {
  const auto as = [&](auto value) {
    std::memcpy(&value, bytes, sizeof value);
    return value;
  };
  switch (type) {
    case kByte:
      return normalized ? std::max(as(std::int8_t{}) / 127.0, -1.0) : as(std::int8_t{});
    case kUByte:
      return as(std::uint8_t{}) / (normalized ? 255.0 : 1);
    case kShort:
      return normalized ? std::max(as(std::int16_t{}) / 32767.0, -1.0) : as(std::int16_t{});
    case kUShort:
      return as(std::uint16_t{}) / (normalized ? 65535.0 : 1);
    case kUInt:
      return as(std::uint32_t{});
    default:
      return static_cast<double>(as(float{}));
  }
}

/// Decodes base64; stops at the first character that is none.
std::string from_base64(std::string_view text) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<std::uint8_t, 256> value;
  value.fill(64);
  for (std::size_t i = 0; i < kDigits.size(); ++i) value[static_cast<unsigned char>(kDigits[i])] = std::uint8_t(i);
  std::string out;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const std::uint8_t digit = value[static_cast<unsigned char>(c)];
    if (digit == 64) break;
    bits = bits << 6 | digit;
    if ((count += 6) < 8) continue;
    count -= 8;
    out += static_cast<char>(bits >> count & 0xff);
  }
  return out;
}

std::size_t count_of(const Json& json) {
  if (!json.is_number_integer() || json < 0) throw std::runtime_error("a count or number is no whole number");
  return json.get<std::size_t>();
}

std::size_t count_of(const Json& object, const char* key, std::size_t otherwise) {
  return object.contains(key) ? count_of(object[key]) : otherwise;
}

}  // namespace

GltfDocument::GltfDocument(const std::filesystem::path& file) : file_(file) {
  GltfContainer container = read_gltf_container(file);
  root_ = std::move(container.json);
  binary_ = std::move(container.binary);
  has_binary_ = container.has_binary;
  if (!root_.is_object() || !root_.contains("asset")) fail("this is no glTF file, or it is cut off");
  if (!root_["asset"].at("version").get<std::string>().starts_with("2.")) fail("its version of glTF is not read");
}

void GltfDocument::fail(const std::string& problem) const { throw InputError(file_.string(), problem); }

const Json& GltfDocument::item(const char* list, const Json& index) const {
  const std::size_t i = count_of(index);
  if (!root_.contains(list) || !root_[list].is_array() || i >= root_[list].size())
    fail(fmt::format("there is no number {} in '{}'", i, list));
  return root_[list][i];
}

std::string_view GltfDocument::buffer(std::size_t index) {
  if (index == 0 && has_binary_ && !item("buffers", 0).contains("uri")) return binary_;
  if (const auto known = buffers_.find(index); known != buffers_.end()) return known->second;
  const Json& json = item("buffers", index);
  if (!json.contains("uri"))
    fail(fmt::format("buffer {} holds no data; compression by EXT_meshopt_compression is not read", index));
  const std::string uri = json["uri"];
  std::string bytes;
  if (uri.starts_with("data:")) {
    const auto comma = uri.find(',');
    if (comma == std::string::npos || uri.substr(0, comma).find(";base64") == std::string::npos)
      fail(fmt::format("buffer {} is encoded in a way that is not read", index));
    bytes = from_base64(std::string_view(uri).substr(comma + 1));
  } else {
    const std::filesystem::path path = file_of_uri(uri, file_);
    if (!may_read_referenced(path, file_)) fail(fmt::format("it names '{}', which is no file in its folder", uri));
    std::ifstream in(path, std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(in), {});
    if (!in) fail(fmt::format("'{}' cannot be read", uri));
  }
  return buffers_.emplace(index, std::move(bytes)).first->second;
}

std::string_view GltfDocument::bytes_of_view(const Json& index) {
  const Json& view = item("bufferViews", index);
  const std::string_view all = buffer(count_of(view.at("buffer")));
  const std::size_t offset = count_of(view, "byteOffset", 0), length = count_of(view.at("byteLength"));
  if (offset > all.size() || length > all.size() - offset)
    fail(fmt::format("buffer view {} goes beyond its buffer, which is cut off", index.dump()));
  return all.substr(offset, length);
}

void GltfDocument::read_items(const Json& view, std::size_t offset, std::size_t type, bool normalized,
                              GltfNumbers& out) {
  const std::string_view bytes = bytes_of_view(view);
  const std::size_t size = size_of(type), width = size * out.components;
  const std::size_t stride = count_of(item("bufferViews", view), "byteStride", width);
  if (out.count == 0) return;
  if (stride == 0 || offset > bytes.size() || width > bytes.size() - offset ||
      out.count - 1 > (bytes.size() - offset - width) / stride)
    fail("an accessor goes beyond its buffer view");
  out.values.resize(out.count * out.components);
  for (std::size_t i = 0; i < out.count; ++i)
    for (std::size_t k = 0; k < out.components; ++k)
      out.values[i * out.components + k] = number(bytes.data() + offset + i * stride + k * size, type, normalized);
}

GltfNumbers GltfDocument::numbers(const Json& index) {
  const Json& accessor = item("accessors", index);
  static const std::map<std::string, std::size_t> components = {
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
  const auto found = components.find(accessor.at("type").get<std::string>());
  const std::size_t type = count_of(accessor.at("componentType"));
  if (found == components.end() || type < kByte || type > kFloat || type == 5124)
    fail(fmt::format("accessor {} has a type that is not read", index.dump()));
  GltfNumbers out;
  out.components = found->second;
  out.count = count_of(accessor.at("count"));
  if (out.count > 3 * reader_process::kInputLimits.triangles)
    fail(fmt::format("accessor {} is too large", index.dump()));
  const bool normalized = accessor.value("normalized", false);
  if (accessor.contains("bufferView"))
    read_items(accessor["bufferView"], count_of(accessor, "byteOffset", 0), type, normalized, out);
  else
    out.values.assign(out.count * out.components, 0);
  if (!accessor.contains("sparse")) return out;
  const Json& sparse = accessor["sparse"];
  GltfNumbers places, changes;
  places.count = changes.count = count_of(sparse.at("count"));
  changes.components = out.components;
  const Json &indices = sparse.at("indices"), &values = sparse.at("values");
  read_items(indices.at("bufferView"), count_of(indices, "byteOffset", 0), count_of(indices.at("componentType")), false,
             places);
  read_items(values.at("bufferView"), count_of(values, "byteOffset", 0), type, normalized, changes);
  for (std::size_t i = 0; i < places.count; ++i) {
    const auto at = static_cast<std::size_t>(places.values[i]);
    if (at >= out.count) fail(fmt::format("accessor {} changes an item that it has not", index.dump()));
    for (std::size_t k = 0; k < out.components; ++k) out.values[at * out.components + k] = changes.at(i, k);
  }
  return out;
}

int version_of_gltf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  char head[8] = {};
  if (in.read(head, sizeof head) && std::string_view(head, 4) == "glTF") return head[4];
  const Json json = read_gltf_container(file).json;
  if (!json.is_object() || !json.contains("asset") || !json["asset"].is_object()) return 0;
  const Json version = json["asset"].value("version", Json());
  return version.is_string() ? std::atoi(version.get<std::string>().c_str()) : 0;
}

}  // namespace dismantle::mesh_files
