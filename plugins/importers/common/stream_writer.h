/// Writes the records of stream_format.h to a file descriptor.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "stream_format.h"

namespace dismantle::reader_process {

struct Body {
  std::string name;
  std::vector<std::string> parents;                   ///< names of the assemblies that contain it, outermost first
  std::vector<std::string> instances;                 ///< as RawPart::instances
  std::string product;                                ///< name of the product whose body it is
  std::optional<std::array<std::uint8_t, 4>> colour;  ///< RGBA, sRGB
  std::string problem;      ///< not empty: reason why it cannot be a part; then it has no triangles
  bool by_meaning = false;  ///< of a problem: the file itself says that it is no part
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Writes the stream. Ends the process when the reading end is closed.
class StreamWriter {
 public:
  explicit StreamWriter(int descriptor);
  void unit(const std::string& name);
  void phase(const std::string& name, std::size_t done, std::size_t total);
  void warning(const std::string& text);
  void note(const std::string& text);
  void body(const Body& body);
  void failure(Failure kind, const std::string& text);
  void end();

 private:
  void record(Tag tag, const std::string& payload);
  void write_all(const char* data, std::size_t size);

  int descriptor_;
  std::uint32_t bodies_ = 0;
};

}  // namespace dismantle::reader_process
