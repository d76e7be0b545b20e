#include "dismantle/fasteners/name.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <vector>

#include "sizes.h"
#include "words.h"

namespace dismantle::fasteners {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || static_cast<unsigned char>(c) >= 0x80; }

std::string lower(std::string_view text) {
  std::string out(text.substr(
      0, text.rfind('#') == std::string_view::npos || text.rfind('#') == 0 ? text.size() : text.rfind('#')));
  // "#2" at the end numbers equal names; "#6-32" is a size.
  if (const auto hash = text.rfind('#'); hash != std::string_view::npos)
    if (!std::all_of(text.begin() + static_cast<long>(hash) + 1, text.end(), is_digit)) out = text;
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

/// Reads numbers from a text.
struct Reader {
  std::string_view text;
  std::size_t at = 0;

  bool end() const { return at >= text.size(); }
  void skip_spaces() {
    while (!end() && (text[at] == ' ' || text[at] == '_')) ++at;
  }
  /// "12", "2.5", "2,5"; negative: none.
  double decimal() {
    std::size_t to = at;
    while (to < text.size() && is_digit(text[to])) ++to;
    if (to == at) return -1;
    if (to + 1 < text.size() && (text[to] == '.' || text[to] == ',') && is_digit(text[to + 1])) {
      ++to;
      while (to < text.size() && is_digit(text[to])) ++to;
    }
    std::string number_text(text.substr(at, to - at));
    std::replace(number_text.begin(), number_text.end(), ',', '.');
    double value = -1;
    std::from_chars(number_text.data(), number_text.data() + number_text.size(), value);
    at = to;
    return value;
  }
  /// "1/2", "1-1/4", "0.5"
  double fraction() {
    const double first = decimal();
    if (first < 0 || end()) return first;
    const std::size_t before = at;
    if (text[at] == '/') {
      ++at;
      const double below = decimal();
      return below > 0 ? first / below : -1;
    }
    if (text[at] == '-' || text[at] == ' ') {
      ++at;
      const double above = decimal();
      if (above > 0 && !end() && text[at] == '/') {
        ++at;
        const double below = decimal();
        if (below > 0) return first + above / below;
      }
    }
    at = before;
    return first;
  }
  /// Skips "x", "*", the multiplication sign or, directly, "-"; false: nothing of these.
  bool times() {
    const std::size_t before = at;
    skip_spaces();
    if (text.substr(at).starts_with("\u00d7")) {
      at += 2;
    } else if (!end() && (text[at] == 'x' || text[at] == '*' || (text[at] == '-' && at == before))) {
      ++at;
    } else {
      at = before;
      return false;
    }
    skip_spaces();
    return true;
  }
};

struct Size {
  std::string thread;
  double length = 0;
  std::size_t from = 0, to = 0;  // in the name
};

/// The last "M3", "M3x10", "M3 x 0.5 x 10" of a name.
Size metric_size(std::string_view name) {
  Size out;
  for (std::size_t i = 0; i + 1 < name.size(); ++i) {
    if (name[i] != 'm' || !is_digit(name[i + 1]) || (i > 0 && (is_letter(name[i - 1]) || is_digit(name[i - 1]))))
      continue;
    Reader reader{name, i + 1};
    const double diameter = reader.decimal();
    if (!(diameter >= 1) || diameter > 100 ||
        (!reader.end() && is_letter(name[reader.at]) && name[reader.at] != 'x' &&
         !name.substr(reader.at).starts_with("\u00d7")))
      continue;
    out = {fmt::format("M{}", number(diameter)), 0, i, reader.at};
    std::vector<double> more;
    while (more.size() < 2 && reader.times()) {
      const double value = reader.decimal();
      if (value < 0) break;
      more.push_back(value);
      out.to = reader.at;
    }
    // A single small number is the pitch of a fine thread.
    if (!more.empty() && (more.size() > 1 || more[0] > 0.3 * diameter)) out.length = more.back();
  }
  return out;
}

/// "1/4-20 x 3/4", "#6-32 x 1/2".
Size inch_size(std::string_view name) {
  for (const Thread& t : threads()) {
    if (!t.inch) continue;
    std::string_view text = t.name;
    std::size_t at = name.find(text);
    if (at == std::string_view::npos && text.front() == '#') at = name.find(text = text.substr(1));
    if (at == std::string_view::npos ||
        (at > 0 && (is_digit(name[at - 1]) || name[at - 1] == '/' || name[at - 1] == '.')))
      continue;
    Reader reader{name, at + text.size()};
    if (!reader.end() && is_digit(name[reader.at])) continue;
    Size out{t.name, 0, at, reader.at};
    if (reader.times()) {
      const double length = reader.fraction();
      if (length > 0) out.length = 25.4 * length, out.to = reader.at;
    }
    return out;
  }
  return {};
}

struct Token {
  std::string_view text;
  std::size_t at;
};

std::vector<Token> tokens_of(std::string_view name) {
  std::vector<Token> out;
  for (std::size_t i = 0; i < name.size();) {
    const auto same = [&](char c) { return is_digit(name[i]) ? is_digit(c) : is_letter(c); };
    if (!is_digit(name[i]) && !is_letter(name[i])) {
      ++i;
      continue;
    }
    std::size_t to = i;
    while (to < name.size() && same(name[to])) ++to;
    out.push_back({name.substr(i, to - i), i});
    i = to;
  }
  return out;
}

int integer(std::string_view text) {
  int value = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() ? value : -1;
}

/// "ANSI B18.2.1", "ASME B18.22.1".
std::optional<Kind> ansi_kind(const std::vector<Token>& tokens, std::size_t i) {
  if (tokens[i].text != "b" || i + 2 >= tokens.size() || tokens[i + 1].text != "18") return std::nullopt;
  const int part = integer(tokens[i + 2].text), section = i + 3 < tokens.size() ? integer(tokens[i + 3].text) : -1;
  if (part == 2) return section == 2 ? Kind::nut : Kind::screw;
  if (part == 3 || part == 5 || part == 6) return Kind::screw;
  if (part == 8) return Kind::pin;
  if (part == 16) return Kind::nut;
  if (part == 21 || part == 22) return Kind::washer;
  if (part == 27) return Kind::ring;
  return std::nullopt;
}

/// The standard that a name states: "ISO 4762", "DIN EN ISO 4762", "DIN912", "ANSI B18.2.1".
bool read_standard(const std::vector<Token>& tokens, NameSays& out) {
  for (std::size_t i = 0; i + 1 < tokens.size(); ++i) {
    const std::string_view body = tokens[i].text;
    if (const auto kind = ansi_kind(tokens, i)) {
      out.kind = kind;
      out.confidence = 0.9;
      out.reason = fmt::format("B18.{}", tokens[i + 2].text);
      return true;
    }
    if (body != "iso" && body != "din") continue;
    const int number = integer(tokens[i + 1].text);
    if (const auto kind = kind_of_standard(body, number)) {
      out.kind = kind;
      out.confidence = 0.95;
      out.reason = fmt::format("{} {}", body == "iso" ? "ISO" : "DIN", number);
      return true;
    }
  }
  return false;
}

}  // namespace

NameSays recognise_name(std::string_view given) {
  const std::string name = lower(given);
  NameSays out;
  const std::vector<Token> tokens = tokens_of(name);
  Size size = metric_size(name);
  if (size.thread.empty()) size = inch_size(name);
  out.thread = size.thread;
  out.length = size.length;
  if (read_standard(tokens, out)) {
    // "2m6x20": the tolerance of a pin is no thread.
    if (out.kind == Kind::pin) {
      for (std::size_t i = 0; i + 1 < name.size(); ++i) {
        if (name[i] != 'm' || (name[i + 1] != '6' && name[i + 1] != '5') || i == 0 || !is_digit(name[i - 1])) continue;
        Reader reader{name, i + 2};
        if (reader.times()) out.length = std::max(0.0, reader.decimal());
      }
      out.thread.clear();
    }
    return out;
  }
  bool other = false;
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    if (tokens[i].text == "lead" && i + 1 < tokens.size() && tokens[i + 1].text == "screw") continue;
    if (tokens[i].text == "plate" && i > 0 && tokens[i - 1].text.starts_with("rondelle")) continue;  // French: flat
    // "2Pin" counts the contacts of a connector.
    if ((tokens[i].text == "pin" || tokens[i].text == "pins") && tokens[i].at > 0 && is_digit(name[tokens[i].at - 1]))
      continue;
    const Word* word = word_of(tokens[i].text);
    // "O-ring" and "stand-off" are two tokens.
    if (tokens[i].text == "ring" && i > 0 &&
        (tokens[i - 1].text == "o" || tokens[i - 1].text == "snap" || tokens[i - 1].text == "retaining")) {
      out.kind = Kind::ring;
    } else if (tokens[i].text == "off" && i > 0 && tokens[i - 1].text == "stand") {
      out.kind = Kind::standoff;
    } else if (word == nullptr) {
      continue;
    } else {
      out.kind = word->kind;
      if (i > 0 && tokens[i - 1].text == "lead" && tokens[i].text == "screw") out.kind = Kind::shaft;
    }
    other = !out.kind;
    out.confidence = 0.8;
    out.reason = std::string(tokens[i].text);
  }
  if (out.kind || other) return out;
  // A size with a length, and no word beside it: "M3x10".
  if (!size.thread.empty() && size.length > 0) {
    std::string rest = name.substr(0, size.from) + name.substr(size.to);
    if (std::none_of(rest.begin(), rest.end(), is_letter)) {
      out.kind = Kind::screw;
      out.confidence = 0.8;
      out.reason = fmt::format("size {}", size.thread);
    }
  }
  return out;
}

}  // namespace dismantle::fasteners
