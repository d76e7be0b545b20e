// STL, text and binary. Vertices are not shared in the file; preparation welds them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>

#include "dismantle/errors.h"
#include "readers.h"
#include "text_scan.h"

namespace dismantle::mesh_files {
namespace {

/// Bytes before the triangles (a comment of 80 bytes, their number), and per triangle (twelve floats, two bytes).
constexpr std::size_t kHeader = 80 + sizeof(std::uint32_t), kRecord = 12 * sizeof(float) + sizeof(std::uint16_t);

/// Header of a binary file.
struct BinaryHeader {
  std::uint64_t size = 0;       ///< of the file
  std::uint32_t triangles = 0;  ///< as stated
  bool says_solid = false;      ///< starts like a text file (many binary files also do)
  bool printable = false;       ///< nothing but text at its beginning
  bool utf16 = false;           ///< starts with the byte order mark of UTF-16
  bool zeros = false;           ///< bytes of zero at its beginning, which text has not
  bool fits() const { return size >= kHeader && size == kHeader + kRecord * std::uint64_t{triangles}; }
};

std::uint32_t little_endian(const unsigned char* p) {
  return static_cast<std::uint32_t>(p[0]) | static_cast<std::uint32_t>(p[1]) << 8 |
         static_cast<std::uint32_t>(p[2]) << 16 | static_cast<std::uint32_t>(p[3]) << 24;
}

std::optional<BinaryHeader> header_of(const std::filesystem::path& file) {
  std::error_code ec;
  BinaryHeader header;
  header.size = std::filesystem::file_size(file, ec);
  std::ifstream in(file, std::ios::binary);
  if (ec || !in) return std::nullopt;
  char bytes[1024] = {};  // of text, blank lines may stand before the first word
  in.read(bytes, sizeof bytes);
  std::string_view start(bytes, static_cast<std::size_t>(in.gcount()));
  header.printable = std::ranges::all_of(start, [](unsigned char c) {
    return c >= 0x20 ? c != 0x7F : std::string_view("\t\n\v\f\r").find(static_cast<char>(c)) != std::string_view::npos;
  });
  header.zeros = start.find('\0') != start.npos;
  header.utf16 = start.starts_with("\xFF\xFE") || start.starts_with("\xFE\xFF");
  if (start.starts_with("\xEF\xBB\xBF")) start.remove_prefix(3);
  start.remove_prefix(std::min(start.find_first_not_of(" \t\n\v\f\r"), start.size()));
  header.says_solid = lower_case(start.substr(0, 5)) == "solid";
  header.triangles = little_endian(reinterpret_cast<const unsigned char*>(bytes) + 80);
  return header;
}

bool is_text(const BinaryHeader& header) { return header.says_solid && !header.zeros && !header.fits(); }

/// Whether what follows the stated triangles is more of them, or another file. Bytes of zero are none of these.
bool goes_on(std::ifstream& in, std::uint64_t behind, std::uint64_t rest) {
  in.seekg(static_cast<std::streamoff>(behind));
  if (std::all_of(std::istreambuf_iterator<char>(in), {}, [](char c) { return c == '\0'; })) return false;
  if (rest % kRecord == 0) return true;
  unsigned char count[4] = {};
  in.clear();
  in.seekg(static_cast<std::streamoff>(behind + kHeader - sizeof count));
  if (!in.read(reinterpret_cast<char*>(count), sizeof count)) return false;
  const std::uint64_t more = little_endian(count);
  return more > 0 && kHeader + kRecord * more <= rest;
}

std::vector<RawPart> read_binary(const std::filesystem::path& file, const BinaryHeader& header,
                                 const RunContext& context) {
  const std::string name = file.string();
  if (header.size < kHeader)
    throw InputError(name, fmt::format("{} bytes are too short for an STL file: it is cut off or no STL", header.size));
  if (header.printable && !header.fits())
    throw InputError(name, "this is no STL file: text that does not begin with 'solid'");
  if (header.utf16 && !header.fits())
    throw InputError(name, "this is text in UTF-16, which STL does not have: save it as ASCII or UTF-8");
  const std::uint64_t expected = kHeader + kRecord * std::uint64_t{header.triangles};
  if (header.size < expected)
    throw InputError(name, fmt::format("cut off: its header states {} triangles, which take {} bytes, but it has {}",
                                       header.triangles, expected, header.size));
  std::ifstream in(file, std::ios::binary);
  if (goes_on(in, expected, header.size - expected))
    throw InputError(name, fmt::format("its header states {} triangles, and there are more behind them: the number is "
                                       "wrong, or several files were joined; export it again",
                                       header.triangles));
  if (header.triangles == 0) throw InputError(name, "no triangles");
  RawPart part;
  part.file = file.filename().string();
  part.mesh.vertices.reserve(std::size_t{3} * header.triangles);
  part.mesh.triangles.reserve(header.triangles);
  in.clear();
  in.seekg(kHeader);
  unsigned char record[kRecord];
  for (std::uint32_t t = 0; t < header.triangles; ++t) {
    if (t % 4096 == 0) stop_if_told(context, file);
    if (!in.read(reinterpret_cast<char*>(record), kRecord))
      throw InputError(name, fmt::format("cannot be read beyond triangle {}", t));
    for (std::size_t corner = 0; corner < 3; ++corner) {
      Eigen::Vector3d v;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t bits = little_endian(record + 12 * (corner + 1) + 4 * k);
        float value;
        std::memcpy(&value, &bits, sizeof value);
        v[static_cast<Eigen::Index>(k)] = static_cast<double>(value);
      }
      if (!v.allFinite()) throw InputError(name, fmt::format("triangle {}: coordinate is not finite", t + 1));
      part.mesh.vertices.push_back(v);
    }
    part.mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  std::vector<RawPart> parts;
  parts.push_back(std::move(part));
  return parts;
}

/// The keyword of a line, in lower case, and its rest; "end loop" is the same as "endloop".
std::string take_keyword(std::string_view& line) {
  std::string keyword = lower_case(take_word(line));
  if (keyword == "end") keyword += lower_case(take_word(line));
  return keyword;
}

std::vector<RawPart> read_text(const std::filesystem::path& file, const RunContext& context) {
  LineReader lines(file, context);
  std::vector<RawPart> parts;
  bool in_solid = false, in_facet = false;
  std::size_t corners = 0;
  std::string_view line;
  while (lines.next(line)) {
    const std::string keyword = take_keyword(line);
    if (keyword == "vertex") {
      if (!in_facet) lines.fail("'vertex' outside of a facet");
      if (++corners > 3) lines.fail("a facet with more than three vertices");
      Eigen::Vector3d v;
      for (int k = 0; k < 3; ++k) v[k] = take_coordinate(line, lines);
      parts.back().mesh.vertices.push_back(v);
    } else if (keyword == "facet") {
      if (!in_solid) lines.fail("'facet' outside of a solid");
      if (in_facet) lines.fail("'facet' inside a facet");
      in_facet = true;
      corners = 0;
    } else if (keyword == "endfacet") {
      if (!in_facet || corners != 3) lines.fail(fmt::format("a facet with {} vertices", corners));
      const auto n = static_cast<std::uint32_t>(parts.back().mesh.vertices.size());
      parts.back().mesh.triangles.push_back({n - 3, n - 2, n - 1});
      in_facet = false;
    } else if (keyword == "solid") {
      if (in_solid) lines.fail("'solid' inside a solid");
      in_solid = true;
      parts.emplace_back();
      parts.back().name = std::string(trimmed(line));
      parts.back().file = file.filename().string();
    } else if (keyword == "endsolid") {
      if (!in_solid || in_facet) lines.fail("'endsolid' where none can be");
      in_solid = false;
    } else if (!keyword.empty() && keyword != "outer" && keyword != "endloop" && keyword != "color") {
      lines.fail("this is no line of an STL file");
    }
  }
  if (in_solid) lines.fail("the file ends inside a solid: it is cut off");
  std::size_t empty = 0;
  for (RawPart& part : parts)
    if (part.mesh.triangles.empty()) {
      part.problem = "it has no triangles";
      ++empty;
    }
  if (empty == parts.size()) throw InputError(file.string(), "no triangles");
  return parts;
}

}  // namespace

std::vector<RawPart> read_stl(const std::filesystem::path& file, const RunContext& context) {
  const auto header = header_of(file);
  if (!header) throw InputError(file.string(), "cannot be opened");
  return is_text(*header) ? read_text(file, context) : read_binary(file, *header, context);
}

std::optional<std::uint64_t> count_stl_triangles(const std::filesystem::path& file) {
  const auto header = header_of(file);
  if (!header) return std::nullopt;
  if (!is_text(*header)) return header->triangles;
  try {
    LineReader lines(file);
    std::uint64_t triangles = 0;
    std::string_view rest;
    while (lines.next(rest)) triangles += take_keyword(rest) == "endfacet";
    return triangles;
  } catch (const InputError&) {
    return std::nullopt;  // read_stl() reports the error
  }
}

}  // namespace dismantle::mesh_files
