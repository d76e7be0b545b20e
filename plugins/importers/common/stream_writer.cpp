#include "stream_writer.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace dismantle::reader_process {
namespace {

template <class T>
void put(std::string& out, const T& value) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  out.append(bytes, sizeof(T));
}

void put_text(std::string& out, const std::string& text) {
  const auto size = static_cast<std::uint32_t>(std::min<std::size_t>(text.size(), kInputLimits.text));
  put(out, size);
  out.append(text, 0, size);
}

void put_texts(std::string& out, const std::vector<std::string>& texts, std::size_t most) {
  const auto size = static_cast<std::uint32_t>(std::min(texts.size(), most));
  put(out, size);
  for (std::uint32_t i = 0; i < size; ++i) put_text(out, texts[i]);
}

}  // namespace

StreamWriter::StreamWriter(int descriptor) : descriptor_(descriptor) { write_all(kMagic, sizeof kMagic); }

void StreamWriter::unit(const std::string& name) {
  std::string payload;
  put_text(payload, name);
  record(Tag::unit, payload);
}

void StreamWriter::phase(const std::string& name, std::size_t done, std::size_t total) {
  std::string payload;
  put_text(payload, name);
  put(payload, static_cast<std::uint32_t>(done));
  put(payload, static_cast<std::uint32_t>(total));
  record(Tag::phase, payload);
}

void StreamWriter::warning(const std::string& text) {
  std::string payload;
  put_text(payload, text);
  record(Tag::warning, payload);
}

void StreamWriter::note(const std::string& text) {
  std::string payload;
  put_text(payload, text);
  record(Tag::note, payload);
}

void StreamWriter::body(const Body& body) {
  std::string payload;
  put_text(payload, body.name);
  put_texts(payload, body.parents, kInputLimits.nesting);
  put_texts(payload, body.instances, kInputLimits.nesting + 1);
  put_text(payload, body.product);
  put(payload, static_cast<std::uint8_t>(body.colour.has_value()));
  for (const std::uint8_t channel : body.colour.value_or(std::array<std::uint8_t, 4>{})) put(payload, channel);
  put_text(payload, body.problem);
  put(payload, static_cast<std::uint8_t>(body.by_meaning));
  put(payload, static_cast<std::uint64_t>(body.vertices.size()));
  put(payload, static_cast<std::uint64_t>(body.triangles.size()));
  record(Tag::body, payload);
  const auto chunks = [&](Tag tag, const auto& items) {
    const std::size_t most = kInputLimits.record / sizeof(items[0]);
    for (std::size_t i = 0; i < items.size(); i += most) {
      payload.clear();
      for (std::size_t k = i; k < std::min(items.size(), i + most); ++k) put(payload, items[k]);
      record(tag, payload);
    }
  };
  chunks(Tag::vertices, body.vertices);
  chunks(Tag::triangles, body.triangles);
  ++bodies_;
}

void StreamWriter::failure(Failure kind, const std::string& text) {
  std::string payload;
  put(payload, static_cast<std::uint8_t>(kind));
  put_text(payload, text);
  record(Tag::failure, payload);
}

void StreamWriter::end() {
  std::string payload;
  put(payload, bodies_);
  record(Tag::end, payload);
}

void StreamWriter::record(Tag tag, const std::string& payload) {
  std::string head;
  put(head, static_cast<std::uint8_t>(tag));
  put(head, static_cast<std::uint32_t>(payload.size()));
  write_all(head.data(), head.size());
  write_all(payload.data(), payload.size());
}

void StreamWriter::write_all(const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t written = ::write(descriptor_, data, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) std::_Exit(3);
    data += written;
    size -= static_cast<std::size_t>(written);
  }
}

}  // namespace dismantle::reader_process
