#include "text_scan.h"

#include <fmt/format.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>

#include "dismantle/errors.h"

namespace dismantle::mesh_files {

namespace {
bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\v' || c == '\f'; }

std::string shown(std::string_view word) {
  std::string s(word.substr(0, 40));
  for (char& c : s)
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7E) c = '?';
  return s;
}
}  // namespace

LineReader::LineReader(const std::filesystem::path& file, const RunContext& context)
    : file_(file), context_(context), block_(1 << 16) {
  errno = 0;
  in_.open(file, std::ios::binary);
  if (!in_) throw InputError(file.string(), fmt::format("cannot be opened: {}", std::strerror(errno)));
}

void stop_if_told(const RunContext& context, const std::filesystem::path& file) {
  if (context.should_stop()) throw Error("stopped while reading " + file.string());
}

/// Reads the next block of the file; false at its end.
bool LineReader::fill() {
  stop_if_told(context_, file_);
  in_.read(block_.data(), static_cast<std::streamsize>(block_.size()));
  if (in_.bad()) fail("the file cannot be read further");
  at_ = 0;
  end_ = static_cast<std::size_t>(in_.gcount());
  if (line_end_ == '\0') {
    const std::string_view block(block_.data(), end_);
    line_end_ = block.find('\n') == block.npos && block.find('\r') != block.npos ? '\r' : '\n';
  }
  return end_ > 0;
}

bool LineReader::next(std::string_view& line) {
  buffer_.clear();
  for (bool any = false, ended = false; !ended; any = true) {
    if (at_ == end_ && !fill()) {
      if (!any) return false;
      break;
    }
    const char* begin = block_.data() + at_;
    const auto* stop = static_cast<const char*>(std::memchr(begin, line_end_, end_ - at_));
    ended = stop != nullptr;
    const std::size_t size = ended ? static_cast<std::size_t>(stop - begin) : end_ - at_;
    buffer_.append(begin, size);
    at_ += size + (ended ? 1 : 0);
    if (buffer_.size() > 1 << 24) {  // bytes: not a text file
      ++number_;
      fail("the line is too long for a mesh file");
    }
  }
  ++number_;
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

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

std::optional<double> to_double(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (word.empty() || end != word.data() + word.size()) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    // Underflow is zero; overflow is not a valid coordinate.
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
