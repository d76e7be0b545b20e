#include "external_files.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <string_view>
#include <system_error>

#include "compressed.h"
#include "dismantle/errors.h"
#include "dismantle/referenced_file.h"

namespace dismantle::step_import {
namespace {

namespace fs = std::filesystem;

/// The first string behind `at`, if nothing but blanks, brackets and `between` stand before it.
std::string string_behind(std::string_view text, std::size_t at, std::string_view between) {
  for (;;) {
    at = text.find_first_not_of(" \t\r\n(", at);
    if (at == text.npos) return {};
    if (!between.empty() && text.substr(at).starts_with(between))
      at += between.size();
    else
      break;
  }
  std::string out;
  if (text[at] != '\'') return out;
  for (++at; at < text.size(); ++at) {
    if (text[at] == '\'' && (at + 1 >= text.size() || text[++at] != '\'')) return out;
    if (out.size() > 4096) return {};
    out += text[at];
  }
  return {};
}

/// Names in the entities by which files refer to others (ISO 10303-44 and the recommended practice for them).
std::set<std::string> names_in(const std::string& text) {
  std::set<std::string> names;
  for (const auto& [keyword, between] : {std::pair<std::string_view, std::string_view>{"DOCUMENT_FILE", ""},
                                         {"APPLIED_EXTERNAL_IDENTIFICATION_ASSIGNMENT", ""},
                                         {"EXTERNAL_SOURCE", "IDENTIFIER"}})
    for (std::size_t at = text.find(keyword); at != text.npos; at = text.find(keyword, at))
      if (const std::string name = string_behind(text, at += keyword.size(), between); !name.empty())
        names.insert(name);
  return names;
}

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// `text`: of `file`.
void search(const fs::path& file, const std::string& text, std::set<fs::path>& seen, ExternalFiles& out) {
  for (const std::string& name : names_in(text)) {
    const fs::path path = file.parent_path() / name;
    std::error_code ec;
    const fs::file_status status = fs::status(path, ec);
    if (!fs::exists(status) || fs::is_directory(status))
      continue;  // reading tells which product it leaves without a shape
    if (!may_read_referenced(path, file)) {
      out.refused.push_back(name);
    } else if (seen.insert(fs::canonical(path, ec)).second) {
      out.read.push_back(path);
      search(path, text_of(path), seen, out);
    }
  }
}

}  // namespace

ExternalFiles external_files(const fs::path& file) {
  ExternalFiles out;
  std::error_code ec;
  std::set<fs::path> seen{fs::canonical(file, ec)};
  if (!fs::is_regular_file(file, ec)) return out;
  try {
    search(file, is_compressed(file) ? unpacked(file) : text_of(file), seen, out);
  } catch (const InputError&) {  // a damaged archive: reading it says so
    return {};
  }
  return out;
}

}  // namespace dismantle::step_import
