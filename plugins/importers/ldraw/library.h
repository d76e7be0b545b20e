/// Finds the files that LDraw files refer to: in the document, beside it, in the parts library.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ldraw_file.h"

namespace dismantle::ldraw {

/// Where a file comes from, which decides what it is.
enum class Origin { document, folder, parts, primitives };

struct Found {
  const LdrawFile* file = nullptr;
  Origin origin = Origin::document;
};

class Library {
 public:
  /// `root`: the folder of the parts library, as named by the user; empty: $LDRAWDIR, or a folder called `library` or
  /// `ldraw` beside the model or beside its folder.
  /// @throws InputError when the document cannot be read, or `root` is not there.
  Library(const std::filesystem::path& model, const std::filesystem::path& root);

  const std::string& first() const { return document_.first; }
  /// Null: it is nowhere. @throws InputError when it is there and cannot be read.
  std::optional<Found> find(const std::string& key);
  /// Why a file is not found, for people.
  std::string why_missing(const std::string& key) const;
  /// Colour of a code, or null: direct colours, and those of the library.
  const Colour* colour(const std::string& code);
  /// Files in the folder of the model that were read.
  const std::vector<std::filesystem::path>& own_files() const { return own_files_; }

 private:
  void index(const std::filesystem::path& folder, const std::string& prefix, Origin origin);
  void read_colours();

  std::filesystem::path model_, root_;
  Document document_;
  std::map<std::string, std::pair<std::filesystem::path, Origin>> indexed_;  // of the library, by key
  std::map<std::string, std::pair<std::unique_ptr<Document>, Origin>> read_;
  std::map<std::string, Colour> colours_;  // by code
  std::vector<std::filesystem::path> own_files_;
};

}  // namespace dismantle::ldraw
