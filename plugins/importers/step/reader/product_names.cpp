#include "product_names.h"

#include <iconv.h>

#include <TCollection_AsciiString.hxx>
#include <TDataStd_Name.hxx>
#include <algorithm>
#include <istream>
#include <map>
#include <optional>
#include <set>
#include <string_view>

namespace dismantle::step_import {
namespace {

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

/// Reads `digits` hexadecimal digits at `i`; -1 when they are not there.
long read_hex(const std::string& text, std::size_t i, std::size_t digits) {
  if (i + digits > text.size()) return -1;
  long value = 0;
  for (std::size_t k = 0; k < digits; ++k) {
    const int d = hex_digit(text[i + k]);
    if (d < 0) return -1;
    value = value * 16 + d;
  }
  return value;
}

void put_utf8(std::string& out, long c) {
  const auto byte = [&](long value) { out += static_cast<char>(static_cast<unsigned char>(value)); };
  if (c < 0x80) {
    byte(c);
  } else if (c < 0x800) {
    byte(0xC0 | (c >> 6));
    byte(0x80 | (c & 0x3F));
  } else if (c < 0x10000) {
    byte(0xE0 | (c >> 12));
    byte(0x80 | ((c >> 6) & 0x3F));
    byte(0x80 | (c & 0x3F));
  } else {
    byte(0xF0 | (c >> 18));
    byte(0x80 | ((c >> 12) & 0x3F));
    byte(0x80 | ((c >> 6) & 0x3F));
    byte(0x80 | (c & 0x3F));
  }
}

/// \X2\....\X0\ and \X4\........\X0\: characters of `digits` digits each; UTF-16 pairs are joined. Returns the place
/// behind it, or `begin` when there is no such directive.
std::size_t read_extended(const std::string& text, std::size_t begin, std::size_t digits, std::string& out) {
  std::string found;
  std::size_t i = begin + 4;
  long high = 0;
  while (text.compare(i, 4, "\\X0\\") != 0) {
    long c = read_hex(text, i, digits);
    if (c < 0 || c > 0x10FFFF) return begin;
    i += digits;
    if (c >= 0xD800 && c < 0xDC00) {
      high = c;
      continue;
    }
    if (c >= 0xDC00 && c < 0xE000) {
      if (high == 0) return begin;
      c = 0x10000 + ((high - 0xD800) << 10) + (c - 0xDC00);
    }
    high = 0;
    put_utf8(found, c);
  }
  out += found;
  return i + 4;
}

/// Nothing when `bytes` are not in this encoding.
std::optional<std::string> converted(std::string bytes, const char* from) {
  const iconv_t tool = ::iconv_open("UTF-8", from);
  if (tool == reinterpret_cast<iconv_t>(-1)) return std::nullopt;
  std::string out(4 * bytes.size() + 4, '\0');
  char *in = bytes.data(), *to = out.data();
  std::size_t left = bytes.size(), room = out.size();
  const std::size_t result = ::iconv(tool, &in, &left, &to, &room);
  ::iconv_close(tool);
  if (result == static_cast<std::size_t>(-1)) return std::nullopt;
  out.resize(out.size() - room);
  return out;
}

const char* name_of(TextEncoding encoding) {
  return encoding == TextEncoding::gb18030 ? "GB18030" : encoding == TextEncoding::utf8 ? "UTF-8" : "WINDOWS-1252";
}

/// What stands in the file from a byte that is not ASCII to the end of its string; samples end with a line break.
std::string samples_of(std::istream& in) {
  std::string samples, block(1 << 16, '\0');
  bool inside = false;
  const std::size_t enough = 1 << 18;  // bytes
  while (samples.size() < enough &&
         (in.read(block.data(), static_cast<std::streamsize>(block.size())), in.gcount() > 0))
    for (const char c : std::string_view(block.data(), static_cast<std::size_t>(in.gcount()))) {
      if (static_cast<unsigned char>(c) >= 0x80) inside = true;
      if (!inside) continue;
      inside = c != '\'' && c != '\n' && c != '\r';
      samples += inside ? c : '\n';
    }
  return samples;
}

/// Chinese names are mostly of two and more characters. Accented letters of other languages, which can look like one
/// such character, mostly stand alone.
bool reads_like_chinese(const std::string& utf8) {
  std::size_t alone = 0, together = 0, run = 0;
  for (std::size_t i = 0; i <= utf8.size(); ++i) {
    const unsigned char c = i < utf8.size() ? static_cast<unsigned char>(utf8[i]) : 0;
    if (c >= 0xE3 && c <= 0xED) ++run;
    if (c >= 0x80 && c < 0xC0) continue;
    if (c >= 0xE3 && c <= 0xED) continue;
    (run == 1 ? alone : together) += run;
    run = 0;
  }
  return together > alone;
}

}  // namespace

TextEncoding encoding_of(std::istream& file) {
  const std::string samples = samples_of(file);
  if (converted(samples, "UTF-8")) return TextEncoding::utf8;
  const std::optional<std::string> chinese = converted(samples, "GB18030");
  return chinese && reads_like_chinese(*chinese) ? TextEncoding::gb18030 : TextEncoding::windows_1252;
}

std::string recoded(const std::string& text, TextEncoding encoding) {
  std::string out, bytes, same;
  const auto flush = [&] {
    std::optional<std::string> read = converted(bytes, "UTF-8");
    if (!read) read = converted(bytes, name_of(encoding));
    out += read.value_or(same);
    bytes.clear();
    same.clear();
  };
  for (std::size_t i = 0; i < text.size();) {
    const auto c = static_cast<unsigned char>(text[i]);
    std::size_t length = c < 0x80 ? 1 : c < 0xE0 ? 2 : c < 0xF0 ? 3 : 4;
    length = std::min(length, text.size() - i);
    const bool byte = length == 1 || (length == 2 && c <= 0xC3);  // U+0000 to U+00FF
    if (byte) {
      bytes += length == 1 ? text[i] : static_cast<char>((c & 3) << 6 | (text[i + 1] & 0x3F));
      same += text.substr(i, length);
    } else {
      flush();
      out += text.substr(i, length);
    }
    i += length;
  }
  flush();
  return out;
}

std::string decoded(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t next = i;
    if (text.compare(i, 4, "\\X2\\") == 0) {
      next = read_extended(text, i, 4, out);
    } else if (text.compare(i, 4, "\\X4\\") == 0) {
      next = read_extended(text, i, 8, out);
    } else if (text.compare(i, 3, "\\X\\") == 0) {
      if (const long c = read_hex(text, i + 3, 2); c >= 0) {
        put_utf8(out, c);
        next = i + 5;
      }
    } else if (text.compare(i, 3, "\\S\\") == 0 && i + 3 < text.size()) {
      put_utf8(out, 0x80 + static_cast<unsigned char>(text[i + 3]));
      next = i + 4;
    } else if (text.compare(i, 2, "\\\\") == 0) {
      out += '\\';
      next = i + 2;
    }
    if (next == i) {
      out += text[i];
      next = i + 1;
    }
    i = next;
  }
  return out;
}

std::string name_of(const TDF_Label& label, TextEncoding encoding) {
  Handle(TDataStd_Name) attribute;
  if (!label.FindAttribute(TDataStd_Name::GetID(), attribute)) return {};
  const TCollection_AsciiString utf8(attribute->Get());
  std::string name = decoded(recoded(utf8.ToCString(), encoding));
  const auto first = name.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return {};
  return name.substr(first, name.find_last_not_of(" \t\r\n") - first + 1);
}

void make_unique(const std::vector<std::string*>& names) {
  std::set<std::string> given, used;
  for (const auto* name : names) given.insert(*name);
  std::map<std::string, int> last;
  for (auto* name : names) {
    if (used.insert(*name).second) continue;
    std::string next;
    int& n = last.try_emplace(*name, 1).first->second;
    do {
      next = *name + "#" + std::to_string(++n);
    } while (given.count(next) || !used.insert(next).second);
    *name = next;
  }
}

}  // namespace dismantle::step_import
