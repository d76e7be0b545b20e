#include "text_scan.h"

#include <fmt/format.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>

#include "dismantle/errors.h"

namespace dismantle::mesh_files {

namespace {
constexpr std::size_t kLongestLine = 1 << 24;
bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

std::string shown(std::string_view word) {
  std::string s(word.substr(0, 40));
  for (char& c : s)
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7E) c = '?';
  return s;
}
}  // namespace

LineReader::LineReader(const std::filesystem::path& file) : file_(file) {
  errno = 0;
  in_.open(file, std::ios::binary);
  if (!in_) throw InputError(file.string(), fmt::format("cannot be opened: {}", std::strerror(errno)));
}

bool LineReader::next(std::string_view& line) {
  if (!std::getline(in_, buffer_)) {
    if (in_.bad()) fail("the file cannot be read further");
    return false;
  }
  ++number_;
  if (buffer_.size() > kLongestLine) fail("the line is too long for a mesh file");
  if (std::memchr(buffer_.data(), 0, buffer_.size())) fail("binary data in a text file");
  line = buffer_;
  if (number_ == 1 && line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return true;
}

void LineReader::fail(const std::string& problem) const {
  throw InputError(file_.string(), fmt::format("line {}: {}", number_, problem));
}

std::string_view take_word(std::string_view& rest) {
  std::size_t i = 0;
  while (i < rest.size() && is_blank(rest[i])) ++i;
  std::size_t j = i;
  while (j < rest.size() && !is_blank(rest[j])) ++j;
  const std::string_view word = rest.substr(i, j - i);
  rest.remove_prefix(j);
  return word;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::optional<double> to_double(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (word.empty() || end != word.data() + word.size()) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    // Too small is zero, too large is no coordinate.
    const auto exponent = word.find_last_of("eE");
    const bool tiny = exponent != std::string_view::npos && exponent + 1 < word.size() && word[exponent + 1] == '-';
    return tiny ? 0.0 : HUGE_VAL;
  }
  if (error != std::errc()) return std::nullopt;
  return value;
}

std::optional<std::int64_t> to_integer(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (word.empty() || error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

double take_coordinate(std::string_view& rest, const LineReader& lines) {
  const std::string_view word = take_word(rest);
  if (word.empty()) lines.fail("a vertex needs three coordinates");
  const auto value = to_double(word);
  if (!value) lines.fail(fmt::format("'{}' is no number", shown(word)));
  if (!std::isfinite(*value)) lines.fail(fmt::format("coordinate '{}' is not finite", shown(word)));
  return *value;
}

}  // namespace dismantle::mesh_files
