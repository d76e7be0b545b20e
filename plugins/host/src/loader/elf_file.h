/// Reads the plugin header out of a shared library's bytes, without loading the library.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace dismantle {

/// Bytes of the symbol `name` in the ELF library `file`: at most `limit` of them, fewer when the symbol is smaller.
/// Also makes sure that every segment lies inside the file: the dynamic linker maps a truncated library
/// without complaint and the process dies on first touch.
/// @throws PluginError: unreadable, no ELF library, truncated, for another machine, or without the symbol.
std::vector<std::uint8_t> read_elf_symbol(const std::filesystem::path& file, const std::string& name,
                                          std::size_t limit);

}  // namespace dismantle
