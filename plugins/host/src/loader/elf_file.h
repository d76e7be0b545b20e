/// Reads what a plugin exports out of a shared library's bytes, without loading the library.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace dismantle {

/// A shared library as bytes. Making one makes sure that every segment lies inside the file: the dynamic linker maps a
/// truncated library without complaint and the process dies on first touch.
class ElfFile {
 public:
  /// @throws PluginError: unreadable, no ELF library, truncated, for another machine.
  explicit ElfFile(const std::filesystem::path& file);
  ~ElfFile();
  /// Bytes of a symbol that it exports: at most `limit` of them, fewer when the symbol is smaller; nothing when there
  /// is none of that name. @throws PluginError: truncated, or without a table of symbols.
  std::optional<std::vector<std::uint8_t>> symbol(const std::string& name, std::size_t limit);

 private:
  class Reader;
  std::unique_ptr<Reader> reader_;
};

}  // namespace dismantle
