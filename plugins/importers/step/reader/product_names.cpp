#include "product_names.h"

#include <TCollection_AsciiString.hxx>
#include <TDataStd_Name.hxx>
#include <map>
#include <set>

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

}  // namespace

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

std::string name_of(const TDF_Label& label) {
  Handle(TDataStd_Name) attribute;
  if (!label.FindAttribute(TDataStd_Name::GetID(), attribute)) return {};
  const TCollection_AsciiString utf8(attribute->Get());
  std::string name = decoded(utf8.ToCString());
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
