#include "ldraw_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <utility>

#include "dismantle/errors.h"

namespace dismantle::ldraw {
namespace {

/// The words of a line, and what is left of it behind some of them.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}

  std::string_view next() {
    skip();
    const std::size_t end = std::min(rest_.find_first_of(" \t\r"), rest_.size());
    const std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return word;
  }
  /// All that is left, without blanks around it.
  std::string_view rest() {
    skip();
    const std::size_t last = rest_.find_last_not_of(" \t\r");
    return last == std::string_view::npos ? std::string_view() : rest_.substr(0, last + 1);
  }

 private:
  void skip() { rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r"), rest_.size())); }
  std::string_view rest_;
};

std::string one_blank(std::string_view text) {
  std::string out;
  for (const char c : text)
    if (!(c == ' ' || c == '\t') || (!out.empty() && out.back() != ' ')) out += c == '\t' ? ' ' : c;
  while (!out.empty() && out.back() == ' ') out.pop_back();
  return out;
}

class Parser {
 public:
  explicit Parser(const std::filesystem::path& file) : file_(file) {}

  Document run(const std::string& text) {
    begin("");
    const char line_end = text.find('\n') == std::string::npos ? '\r' : '\n';
    std::size_t at = text.starts_with("\xEF\xBB\xBF") ? 3 : 0;
    while (at < text.size()) {
      const std::size_t end = std::min(text.find(line_end, at), text.size());
      ++line_;
      read(std::string_view(text).substr(at, end - at));
      at = end + 1;
    }
    finish();
    if (out_.files.empty()) throw InputError(file_.string(), "it holds no LDraw lines");
    return std::move(out_);
  }

 private:
  void begin(std::string_view name) {
    current_ = {};
    current_.name = name;
    clockwise_ = false;
    inverted_ = false;
    content_ = false;
    skipping_ = false;
    first_ = true;
    textured_ = {};
    stored_.clear();
    synth_.clear();
    bent_.reset();
  }

  void finish() {
    end_texture();
    end_bent();
    if (skipping_ || (current_.name.empty() && !content_)) return;
    const std::string key = name_key(current_.name.empty() ? file_.filename().string() : current_.name);
    if (out_.files.empty()) out_.first = key;
    if (!out_.files.emplace(key, std::move(current_)).second)
      throw InputError(file_.string(), fmt::format("line {}: the block '{}' is there twice", line_, key));
  }

  void read(std::string_view line) {
    Words words(line);
    const std::string_view type = words.next();
    if (type == "0") return statement(words);
    if (skipping_ || type.empty()) return;
    content_ = true;
    textured_.other = textured_.other || (textured_.fallback && type != "2" && type != "5");
    if (type == "1") return reference(words);
    if (type == "3" || type == "4") return polygon(words, type == "3" ? 3 : 4);
    if (type != "2" && type != "5") fail(fmt::format("'{}' is no type of line", std::string(type.substr(0, 20))));
  }

  void statement(Words words) {
    const Words whole = words;
    const std::string_view word = words.next();
    if (word == "FILE") {
      finish();
      begin(words.rest());
      return;
    }
    if (word == "NOFILE") {
      finish();
      begin("");
      skipping_ = true;
      return;
    }
    if (skipping_) return;
    if (!content_ && first_ && !word.empty() && word[0] != '!' && word != "Name:") {
      current_.description = one_blank(Words(whole).rest());
      first_ = false;
      content_ = true;
    } else if (word == "!LDRAW_ORG" || word == "LDRAW_ORG") {
      current_.type = words.next();
    } else if (word == "!CATEGORY") {
      current_.category = one_blank(words.rest());
    } else if (word == "BFC") {
      bfc(words);
    } else if (word == "STEP") {
      current_.steps.push_back({current_.references.size(), {}, {}, false});
    } else if (word == "ROTSTEP") {
      turn(words);
    } else if (word == "!COLOUR") {
      colour(words);
    } else if (word == "MLCAD") {
      if (words.next() == "HIDE") hide(words, "it is hidden in the file (MLCAD HIDE)");
    } else if (word == "GHOST") {
      hide(words, "it is hidden in the file (GHOST)");
    } else if (word == "BUFEXCHG") {
      exchange(words);
    } else if (word == "SYNTH" || word == "!LDCAD") {
      bent(word, words);
    } else if (word == "!TEXMAP" || word == "!:") {
      texture(word, words);
    }
  }

  void hide(Words words, const std::string& why) {
    if (words.next() != "1") return;
    reference(words);
    current_.hidden.push_back({std::move(current_.references.back()), why});
    current_.references.pop_back();
  }

  /// MLCad's buffers: what was added since the buffer was stored is taken away again.
  void exchange(Words& words) {
    const std::string buffer(words.next());
    const std::string_view what = words.next();
    if (what == "STORE") stored_[buffer] = current_.references.size();
    const auto found = stored_.find(buffer);
    if (what != "RETRIEVE" || found == stored_.end()) return;
    auto& all = current_.references;
    for (std::size_t i = found->second; i < all.size(); ++i)
      current_.hidden.push_back({std::move(all[i]), "the file takes it away again (BUFEXCHG)"});
    all.resize(std::min(all.size(), found->second));
    if (bent_) bent_->first = std::min(bent_->first, all.size());
    std::erase_if(current_.bent, [&](Bent& b) {
      b.end = std::min(b.end, all.size());
      return b.end <= b.first;
    });
    for (StepEnd& step : current_.steps) step.before = std::min(step.before, all.size());
  }

  void bent(std::string_view program, Words& words) {
    const std::string_view what = words.next();
    if (program == "!LDCAD") {
      if (what == "GENERATED") begin_bent("");
      return;
    }
    if (what == "BEGIN") synth_ = words.next();
    if (what != "SYNTHESIZED") return;
    const std::string_view edge = words.next();
    if (edge == "BEGIN") begin_bent(synth_);
    if (edge == "END") end_bent();
  }

  void begin_bent(const std::string& name) {
    end_bent();
    bent_ = Bent{name, current_.references.size(), 0};
  }

  void end_bent() {
    if (!bent_) return;
    bent_->end = current_.references.size();
    if (bent_->end > bent_->first) current_.bent.push_back(*std::move(bent_));
    bent_.reset();
  }

  /// Lines behind "0 !:" are for programs that draw textures, those behind FALLBACK for the others. Only one of both
  /// is read: the fallback, if it has any surface.
  void texture(std::string_view word, Words& words) {
    if (word == "!:") {
      if (textured_.next) read(words.rest());
      if (textured_.open && !textured_.fallback) textured_.lines.emplace_back(words.rest());
      textured_.next = false;
      return;
    }
    const std::string_view what = words.next();
    if (what == "START") textured_ = {.open = true};
    if (what == "FALLBACK") textured_.fallback = textured_.open;
    if (what == "NEXT") textured_.next = true;
    if (what == "END") end_texture();
  }

  void end_texture() {
    const Textured block = std::exchange(textured_, {});
    if (!block.other)
      for (const std::string& line : block.lines) read(line);
  }

  void bfc(Words& words) {
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      if (word == "CW") clockwise_ = true;
      if (word == "CCW") clockwise_ = false;
      if (word == "INVERTNEXT") inverted_ = true;
    }
  }

  void turn(Words& words) {
    StepEnd step;
    step.before = current_.references.size();
    if (Words look = words; look.next() == "END") {
      step.ends_turn = true;
    } else {
      const double x = number(words), y = number(words), z = number(words);
      step.turn = Eigen::Vector3d(x, y, z);
      step.mode = words.next();
      if (step.mode.empty()) step.mode = "REL";
    }
    current_.steps.push_back(std::move(step));
  }

  void colour(Words& words) {
    Colour c;
    words.next();  // its name
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      if (word == "CODE") c.code = words.next();
      if (word == "VALUE") c.value = words.next();
      if (word == "RUBBER") c.rubber = true;
    }
    content_ = true;
    if (!c.code.empty() && !c.value.empty()) current_.colours.push_back(std::move(c));
  }

  void reference(Words& words) {
    Reference r;
    r.colour = words.next();
    for (Eigen::Index i = 0; i < 3; ++i) r.placement.shift[i] = number(words);
    for (Eigen::Index row = 0; row < 3; ++row)
      for (Eigen::Index column = 0; column < 3; ++column) r.placement.linear(row, column) = number(words);
    r.name = name_key(words.rest());
    if (r.name.empty()) fail("a reference without the name of a file");
    r.inverted = std::exchange(inverted_, false);
    current_.references.push_back(std::move(r));
  }

  void polygon(Words& words, int corners) {
    Polygon p;
    p.colour = words.next();
    for (int k = 0; k < corners; ++k) {
      const double x = number(words), y = number(words), z = number(words);
      p.corners.emplace_back(x, y, z);
    }
    p.clockwise = clockwise_;
    current_.polygons.push_back(std::move(p));
  }

  double number(Words& words) {
    std::string_view word = words.next();
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
      fail(fmt::format("'{}' is no number", std::string(word.substr(0, 40))));
    return value;
  }

  [[noreturn]] void fail(const std::string& problem) const {
    throw InputError(file_.string(), fmt::format("line {}: {}", line_, problem));
  }

  const std::filesystem::path& file_;
  Document out_;
  LdrawFile current_;
  std::size_t line_ = 0;
  bool clockwise_ = false, inverted_ = false;
  bool first_ = true;      // the next statement is the description
  bool content_ = false;   // the block holds a line
  bool skipping_ = false;  // behind NOFILE
  struct Textured {        // a block of !TEXMAP
    bool open = false, fallback = false, next = false;
    bool other = false;  // its fallback has surfaces
    std::vector<std::string> lines{};
  };
  Textured textured_;
  std::string synth_;                          // what LSynth makes in this block
  std::optional<Bent> bent_;                   // the part that bends whose segments are read now
  std::map<std::string, std::size_t> stored_;  // MLCad's buffers: numbers of references
};

}  // namespace

std::string name_key(std::string_view name) {
  std::string key(name);
  for (char& c : key) c = c == '\\' ? '/' : c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return key;
}

Document parse(const std::string& text, const std::filesystem::path& file) { return Parser(file).run(text); }

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(file.string(), fmt::format("cannot be opened: {}", std::strerror(errno)));
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace dismantle::ldraw
