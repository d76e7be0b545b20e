/// Reads exported symbols from the bytes of a shared library, without loading it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace dismantle {

/// A shared library as bytes. The constructor checks that every segment is inside the file: the dynamic linker maps a
/// truncated library without an error, and the process crashes at the first access.
class ElfFile {
 public:
  /// @throws PluginError: unreadable, not an ELF library, truncated, or for another machine.
  explicit ElfFile(const std::filesystem::path& file);
  ~ElfFile();
  /// The first bytes of an exported symbol, at most `limit`; nothing when there is no such symbol.
  /// @throws PluginError: truncated, or without a symbol table.
  std::optional<std::vector<std::uint8_t>> symbol(const std::string& name, std::size_t limit);

 private:
  class Reader;
  std::unique_ptr<Reader> reader_;
};

}  // namespace dismantle
