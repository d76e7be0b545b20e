/// Reads the stream of the reader program (stream_format.h) piece by piece and checks everything in it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dismantle/importer.h"
#include "stream_format.h"

namespace dismantle::reader_process {

class StreamReader {
 public:
  using OnPhase = std::function<void(const std::string& phase, std::size_t done, std::size_t total)>;

  /// Refuses streams with more than `max_triangles` in all bodies together.
  StreamReader(std::uint64_t max_triangles, OnPhase on_phase);

  /// Returns false when the stream is invalid: see problem(). Uses memory in proportion to the bytes received.
  bool feed(std::span<const std::byte> bytes);

  const std::string& problem() const { return problem_; }
  /// True when all announced bodies were received.
  bool complete() const { return ended_ && problem_.empty(); }
  struct Reported {
    Failure kind = Failure::unreadable;
    std::string text;
  };
  /// The failure that the reader program reported.
  const std::optional<Reported>& failure() const { return failure_; }
  const std::vector<std::string>& warnings() const { return warnings_; }
  const std::vector<std::string>& notes() const { return notes_; }
  std::vector<RawPart> take_parts();

 private:
  class Payload;
  void record(Tag tag, Payload payload);
  void begin_body(Payload& payload);
  void add_vertices(Payload& payload);
  void add_triangles(Payload& payload);
  void finish_body();

  std::uint64_t max_triangles_;
  OnPhase on_phase_;
  std::vector<std::byte> pending_;  // less than one record
  bool magic_ = false, ended_ = false;
  std::string problem_, unit_;
  std::optional<Reported> failure_;
  std::vector<std::string> warnings_, notes_;
  std::vector<RawPart> parts_;
  std::uint64_t vertices_left_ = 0, triangles_left_ = 0, triangles_ = 0;
};

}  // namespace dismantle::reader_process
