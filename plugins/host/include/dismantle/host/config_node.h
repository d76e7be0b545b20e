/// A YAML text as a tree in which every key and value has its place in the file.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dismantle/errors.h"
#include "dismantle/export.h"

namespace dismantle {

/// A place in a source. Lines and columns count from 1; 0 = unknown.
struct ConfigMark {
  std::shared_ptr<const std::string> source;  ///< file name as the user gave it, or "<--set>"
  int line = 0;
  int column = 0;

  std::string file() const { return source ? *source : std::string(); }
  /// `file:line`, for comments.
  DISMANTLE_API std::string text() const;
  /// `file:line:column: message`.
  DISMANTLE_API std::string warning(const std::string& message) const;
  DISMANTLE_API Diagnostic error(std::string message) const;
};

struct ConfigMember;

/// A node of the YAML tree. Scalars are kept as text: the parameter that reads one decides its type.
struct DISMANTLE_API ConfigNode {
  /// Kind of a YAML node.
  enum class Kind { null, scalar, sequence, map };
  Kind kind = Kind::null;
  std::string scalar;
  bool quoted = false;  ///< scalar in quotes or block style: always text
  ConfigMark mark;
  std::vector<ConfigNode> items;      ///< of a sequence
  std::vector<ConfigMember> members;  ///< of a map, in file order, no key twice
  bool cut_off = false;               ///< root only: the text is broken, and nothing after the reported place was read

  bool is_map() const { return kind == Kind::map; }
  bool is_scalar() const { return kind == Kind::scalar; }
  const ConfigMember* find(const std::string& key) const;  ///< nullptr when there is none
  ConfigMember* find(const std::string& key);
  void erase(const std::string& key);
  std::string_view kind_name() const;  ///< "a map", "a list", "a value", "nothing"
};

/// A key of a map with its value, and the place of each.
struct ConfigMember {
  std::string key;
  ConfigMark key_mark;
  ConfigNode value;
};

/// Reads one YAML document. Errors (syntax, a repeated key, several documents, tags, more than 64 levels
/// or 100 000 nodes) are appended to `problems`; the tree then contains what could be read.
/// An empty document is an empty map. Never throws because of the text.
DISMANTLE_API ConfigNode parse_yaml(const std::string& text, const std::string& source,
                                    std::vector<Diagnostic>& problems);

/// The same for a file of at most 1 MiB. If the file cannot be read, returns false and sets `unreadable`.
DISMANTLE_API bool read_yaml(const std::string& file, ConfigNode& node, std::vector<Diagnostic>& problems,
                             std::string& unreadable);

}  // namespace dismantle
