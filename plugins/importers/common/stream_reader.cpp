#include "stream_reader.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>
#include <utility>

namespace dismantle::reader_process {
namespace {

struct Broken {
  std::string what;
};

}  // namespace

/// The bytes of one record. Reading past its end is an error.
class StreamReader::Payload {
 public:
  explicit Payload(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <class T>
  T take() {
    if (bytes_.size() < sizeof(T)) throw Broken{"a record is too short"};
    T value;
    std::memcpy(&value, bytes_.data(), sizeof(T));
    bytes_ = bytes_.subspan(sizeof(T));
    return value;
  }

  std::string text() {
    const auto size = take<std::uint32_t>();
    if (size > kInputLimits.text || size > bytes_.size()) throw Broken{"a text is too long"};
    std::string out(reinterpret_cast<const char*>(bytes_.data()), size);
    bytes_ = bytes_.subspan(size);
    return out;
  }

  std::size_t size() const { return bytes_.size(); }
  void expect_end() const {
    if (!bytes_.empty()) throw Broken{"a record is too long"};
  }

 private:
  std::span<const std::byte> bytes_;
};

StreamReader::StreamReader(std::uint64_t max_triangles, OnPhase on_phase)
    : max_triangles_(max_triangles), on_phase_(std::move(on_phase)) {}

bool StreamReader::feed(std::span<const std::byte> bytes) {
  const std::size_t head_size = sizeof(std::uint8_t) + sizeof(std::uint32_t);
  if (!problem_.empty()) return false;
  pending_.insert(pending_.end(), bytes.begin(), bytes.end());
  std::span<const std::byte> rest = pending_;
  try {
    if (!magic_) {
      if (rest.size() < sizeof kMagic) return true;
      if (std::memcmp(rest.data(), kMagic, sizeof kMagic) != 0) throw Broken{"it does not begin as it should"};
      rest = rest.subspan(sizeof kMagic);
      magic_ = true;
    }
    while (rest.size() >= head_size) {
      Payload head(rest.first(head_size));
      const auto tag = static_cast<Tag>(head.take<std::uint8_t>());
      const auto size = head.take<std::uint32_t>();
      if (size > kInputLimits.record) throw Broken{"a record is too long"};
      if (rest.size() < head_size + size) break;
      record(tag, Payload(rest.subspan(head_size, size)));
      rest = rest.subspan(head_size + size);
    }
  } catch (const Broken& broken) {
    problem_ = broken.what;
    return false;
  }
  pending_.erase(pending_.begin(), pending_.end() - static_cast<std::ptrdiff_t>(rest.size()));
  return true;
}

void StreamReader::record(Tag tag, Payload payload) {
  if (ended_ || failure_) throw Broken{"it goes on after its end"};
  if (tag != Tag::vertices && tag != Tag::triangles) finish_body();
  switch (tag) {
    case Tag::unit:
      unit_ = payload.text();
      break;
    case Tag::phase: {
      const std::string phase = payload.text();
      const auto done = payload.take<std::uint32_t>(), total = payload.take<std::uint32_t>();
      if (on_phase_) on_phase_(phase, done, total);
      break;
    }
    case Tag::warning:
    case Tag::note: {
      auto& texts = tag == Tag::warning ? warnings_ : notes_;
      if (texts.size() >= kInputLimits.instances) throw Broken{"too many warnings"};
      texts.push_back(payload.text());
      break;
    }
    case Tag::body:
      begin_body(payload);
      break;
    case Tag::vertices:
      add_vertices(payload);
      break;
    case Tag::triangles:
      add_triangles(payload);
      break;
    case Tag::failure: {
      const auto kind = static_cast<Failure>(payload.take<std::uint8_t>());
      failure_ = Reported{kind, payload.text()};
      break;
    }
    case Tag::end:
      if (payload.take<std::uint32_t>() != parts_.size()) throw Broken{"bodies are missing"};
      ended_ = true;
      break;
    default:
      throw Broken{fmt::format("a record of unknown kind {}", static_cast<int>(tag))};
  }
  payload.expect_end();
}

void StreamReader::begin_body(Payload& payload) {
  if (parts_.size() >= kInputLimits.instances) throw Broken{"too many bodies"};
  RawPart part;
  part.name = payload.text();
  const auto texts = [&](std::vector<std::string>& out, std::size_t most) {
    const auto size = payload.take<std::uint32_t>();
    if (size > most) throw Broken{"a body is nested too deep"};
    for (std::uint32_t i = 0; i < size; ++i) out.push_back(payload.text());
  };
  texts(part.parents, kInputLimits.nesting);
  texts(part.instances, kInputLimits.nesting + 1);
  part.product = payload.text();
  const bool coloured = payload.take<std::uint8_t>() != 0;
  const auto rgba = payload.take<std::array<std::uint8_t, 4>>();
  if (coloured) part.colour = Rgba{rgba[0], rgba[1], rgba[2], rgba[3]};
  part.problem = payload.text();
  part.by_meaning = payload.take<std::uint8_t>() != 0;
  part.unit = unit_;
  vertices_left_ = payload.take<std::uint64_t>();
  triangles_left_ = payload.take<std::uint64_t>();
  if (triangles_left_ > max_triangles_ - triangles_) throw Broken{"too many triangles"};
  if (vertices_left_ > 3 * triangles_left_) throw Broken{"more vertices than triangles have corners"};
  if (part.problem.empty() && triangles_left_ == 0) throw Broken{"a body without triangles"};
  triangles_ += triangles_left_;
  parts_.push_back(std::move(part));
}

void StreamReader::add_vertices(Payload& payload) {
  if (parts_.empty()) throw Broken{"vertices of no body"};
  const std::size_t item = 3 * sizeof(double);
  const std::size_t count = payload.size() / item;
  if (count > vertices_left_) throw Broken{"more vertices than were announced"};
  vertices_left_ -= count;
  auto& vertices = parts_.back().mesh.vertices;
  for (std::size_t i = 0; i < count; ++i) {
    const auto v = payload.take<std::array<double, 3>>();
    if (!std::isfinite(v[0]) || !std::isfinite(v[1]) || !std::isfinite(v[2]))
      throw Broken{fmt::format("'{}': a coordinate is no finite number", parts_.back().name)};
    vertices.emplace_back(v[0], v[1], v[2]);
  }
}

void StreamReader::add_triangles(Payload& payload) {
  if (parts_.empty()) throw Broken{"triangles of no body"};
  const std::size_t count = payload.size() / sizeof(Triangle);
  if (count > triangles_left_) throw Broken{"more triangles than were announced"};
  if (count > 0 && vertices_left_ > 0) throw Broken{"triangles before their vertices"};
  triangles_left_ -= count;
  Mesh& mesh = parts_.back().mesh;
  for (std::size_t i = 0; i < count; ++i) {
    const auto t = payload.take<Triangle>();
    for (const auto corner : t)
      if (corner >= mesh.vertices.size())
        throw Broken{
            fmt::format("'{}': a triangle names vertex {} of {}", parts_.back().name, corner, mesh.vertices.size())};
    mesh.triangles.push_back(t);
  }
}

void StreamReader::finish_body() {
  if (vertices_left_ > 0 || triangles_left_ > 0) throw Broken{"a body is cut off"};
}

std::vector<RawPart> StreamReader::take_parts() { return std::move(parts_); }

}  // namespace dismantle::reader_process
