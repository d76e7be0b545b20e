// Object File Format (text), in double precision.
#include <fmt/format.h>

#include "dismantle/errors.h"
#include "dismantle/geometry/mesh_measure.h"
#include "readers.h"
#include "text_scan.h"

namespace dismantle::mesh_files {
namespace {

/// Skips empty lines and comments.
bool next_filled(LineReader& lines, std::string_view& line) {
  while (lines.next(line)) {
    line = trimmed(line.substr(0, line.find('#')));
    if (!line.empty()) return true;
  }
  return false;
}

std::uint64_t take_count(std::string_view& rest, const LineReader& lines) {
  const auto n = to_integer(take_word(rest));
  if (!n || *n < 0 || *n > 0xfffffffell) lines.fail("the numbers of vertices, faces and edges belong here");
  return static_cast<std::uint64_t>(*n);
}

}  // namespace

std::vector<RawPart> read_off(const std::filesystem::path& file, const RunContext& context) {
  LineReader lines(file, context);
  std::string_view line;
  if (!next_filled(lines, line)) throw InputError(file.string(), "the file is empty");
  std::string_view rest = line;
  const std::string_view magic = take_word(rest);
  if (magic.ends_with("OFF")) {
    if (magic != "OFF" && magic != "COFF" && magic != "NOFF" && magic != "CNOFF" && magic != "STOFF")
      lines.fail("only three-dimensional OFF files are read");
    if (trimmed(rest) == "BINARY") lines.fail("binary OFF files are not read");
    line = trimmed(rest);
    if (line.empty() && !next_filled(lines, line)) lines.fail("the file ends before its numbers of vertices and faces");
  } else if (!to_integer(magic)) {
    lines.fail("an OFF file starts with 'OFF'");
  }
  const std::uint64_t vertices = take_count(line, lines), faces = take_count(line, lines);

  RawPart part;
  part.file = file.filename().string();
  for (std::uint64_t i = 0; i < vertices; ++i) {
    if (!next_filled(lines, line)) lines.fail(fmt::format("cut off after {} of {} vertices", i, vertices));
    Eigen::Vector3d v;
    for (int k = 0; k < 3; ++k) v[k] = take_coordinate(line, lines);
    part.mesh.vertices.push_back(v);
  }
  std::vector<std::uint32_t> corners;
  std::vector<Eigen::Vector3d> points;
  for (std::uint64_t i = 0; i < faces; ++i) {
    if (!next_filled(lines, line)) lines.fail(fmt::format("cut off after {} of {} faces", i, faces));
    const auto n = to_integer(take_word(line));
    if (!n || *n < 0 || *n > 1'000'000) lines.fail("a face starts with its number of corners");
    corners.clear();
    points.clear();
    for (std::int64_t k = 0; k < *n; ++k) {
      const auto v = to_integer(take_word(line));
      if (!v || *v < 0 || static_cast<std::uint64_t>(*v) >= vertices)
        lines.fail(
            fmt::format("corner {} of the face names no vertex (there are {}, counted from 0)", k + 1, vertices));
      corners.push_back(static_cast<std::uint32_t>(*v));
      points.push_back(part.mesh.vertices[corners.back()]);
    }
    if (*n < 3) continue;  // points and lines
    const auto cut = triangulate_polygon(points);
    for (const auto& t : cut) part.mesh.triangles.push_back({corners[t[0]], corners[t[1]], corners[t[2]]});
    if (cut.empty())  // self-intersecting or without area: a fan keeps the surface closed
      for (std::size_t k = 2; k < corners.size(); ++k)
        part.mesh.triangles.push_back({corners[0], corners[k - 1], corners[k]});
  }
  if (next_filled(lines, line)) lines.fail(fmt::format("it goes on behind the {} faces that it states", faces));
  if (part.mesh.triangles.empty()) throw InputError(file.string(), "no faces");
  std::vector<RawPart> parts;
  parts.push_back(std::move(part));
  return parts;
}

}  // namespace dismantle::mesh_files
