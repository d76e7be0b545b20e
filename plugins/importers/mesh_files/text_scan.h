/// Reads numbers and words from lines, independent of the locale; errors name file and line.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dismantle/run_context.h"

namespace dismantle::mesh_files {

/// Lines of a text file without line ends: LF, CRLF, or CR in a file whose first block has no LF. Refuses binary data
/// and overlong lines before they use memory.
class LineReader {
 public:
  /// @throws InputError when the file cannot be opened.
  explicit LineReader(const std::filesystem::path& file, const RunContext& context = {});
  /// False at the end. The view is valid until the next call. @throws InputError on read errors and binary data, Error
  /// when the context requests a stop.
  bool next(std::string_view& line);
  /// @throws InputError "FILE: line N: problem".
  [[noreturn]] void fail(const std::string& problem) const;
  std::size_t number() const { return number_; }

 private:
  bool fill();

  std::filesystem::path file_;
  RunContext context_;
  std::ifstream in_;
  std::vector<char> block_;
  std::size_t at_ = 0, end_ = 0;  // range of the block that is not read yet
  char line_end_ = '\0';          // not known before the first block
  std::string buffer_;
  std::size_t number_ = 0;
};

/// Removes and returns the next word (no blanks) of `rest`; empty at the end.
std::string_view take_word(std::string_view& rest);
std::string_view trimmed(std::string_view text);
/// ASCII letters in lower case.
std::string lower_case(std::string_view text);

/// The whole word as a number. Accepts a leading '+', infinity and NaN.
std::optional<double> to_double(std::string_view word);
std::optional<std::int64_t> to_integer(std::string_view word);

/// @throws Error when the context requests a stop. For readers of long files without lines.
void stop_if_told(const RunContext& context, const std::filesystem::path& file);

/// Takes the next word of `rest` as a finite coordinate. @throws InputError through `lines`.
double take_coordinate(std::string_view& rest, const LineReader& lines);

}  // namespace dismantle::mesh_files
