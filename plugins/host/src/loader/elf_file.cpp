#include "loader/elf_file.h"

#include <elf.h>
#include <fmt/format.h>
#include <link.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <optional>

#include "dismantle/errors.h"

namespace dismantle {
namespace {

using Header = ElfW(Ehdr);
using Segment = ElfW(Phdr);
using Section = ElfW(Shdr);
using Symbol = ElfW(Sym);

}  // namespace

class ElfFile::Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : file_(file), stream_(file, std::ios::binary) {
    if (!stream_) fail("cannot be read");
    stream_.seekg(0, std::ios::end);
    size_ = static_cast<std::uint64_t>(std::max<std::streamoff>(0, stream_.tellg()));
    check_identity();
    if (header_.e_type != ET_DYN) fail("is an ELF file, but no shared library");
    if (here_.processor != EM_NONE && header_.e_machine != here_.processor)
      fail(fmt::format("is built for another processor (ELF machine {}, this one is {}); rebuild the plugin here",
                       header_.e_machine, here_.processor));
    check_segments();
  }

  std::optional<std::vector<std::uint8_t>> symbol(const std::string& name, std::size_t limit) {
    if (header_.e_shoff == 0 || header_.e_shnum == 0) fail("has no section table; do not strip it off");
    const auto sections = table<Section>(header_.e_shoff, header_.e_shnum, "section table");
    for (const auto& section : sections) {
      if (section.sh_type != SHT_DYNSYM) continue;
      const auto found = find_in(section, sections, name);
      if (found) return content(*found, sections, limit);
    }
    return std::nullopt;
  }

 private:
  /// What ELF files for this machine state in their header.
  struct ThisMachine {
#if defined(__x86_64__)
    unsigned processor = EM_X86_64;
#elif defined(__aarch64__)
    unsigned processor = EM_AARCH64;
#elif defined(__riscv)
    unsigned processor = EM_RISCV;
#else
    unsigned processor = EM_NONE;  // unknown: left to the dynamic linker
#endif
    unsigned char word_size = sizeof(void*) == 8 ? ELFCLASS64 : ELFCLASS32;
    unsigned char byte_order = std::endian::native == std::endian::little ? ELFDATA2LSB : ELFDATA2MSB;
  };

  [[noreturn]] void fail(const std::string& problem) const { throw PluginError(file_.string(), problem); }

  void check_identity() {
    unsigned char ident[EI_NIDENT] = {};
    if (size_ < sizeof(ident)) fail("is no ELF shared library: name the .so file that the build of the plugin made");
    read(0, ident, sizeof(ident));
    if (std::memcmp(ident, ELFMAG, SELFMAG) != 0)
      fail("is no ELF shared library: name the .so file that the build of the plugin made");
    if (ident[EI_CLASS] != here_.word_size || ident[EI_DATA] != here_.byte_order)
      fail(fmt::format("is built for another kind of machine (ELF class {}, byte order {}; this one has {}, {})",
                       ident[EI_CLASS], ident[EI_DATA], here_.word_size, here_.byte_order));
    if (size_ < sizeof(Header)) fail(truncated("header", sizeof(Header)));
    read(0, &header_, sizeof(header_));
  }

  void check_segments() {
    for (const auto& segment : table<Segment>(header_.e_phoff, header_.e_phnum, "segment table"))
      if (segment.p_type == PT_LOAD || segment.p_type == PT_DYNAMIC)
        require(segment.p_offset, segment.p_filesz, "segment");
  }

  std::string truncated(const char* what, std::uint64_t end) const {
    return fmt::format("is truncated: its {} ends at byte {}, the file has {}; copy or build it again", what, end,
                       size_);
  }

  void require(std::uint64_t offset, std::uint64_t size, const char* what) const {
    if (offset > size_ || size > size_ - offset) fail(truncated(what, offset + size));
  }

  void read(std::uint64_t offset, void* to, std::size_t size) {
    stream_.clear();
    stream_.seekg(static_cast<std::streamoff>(offset));
    stream_.read(static_cast<char*>(to), static_cast<std::streamsize>(size));
    if (!stream_) fail("cannot be read");
  }

  template <class T>
  std::vector<T> table(std::uint64_t offset, std::uint64_t count, const char* what) {
    if (count > size_ / sizeof(T)) fail(truncated(what, offset + count * sizeof(T)));
    require(offset, count * sizeof(T), what);
    std::vector<T> entries(count);
    if (count > 0) read(offset, entries.data(), count * sizeof(T));
    return entries;
  }

  std::optional<Symbol> find_in(const Section& section, const std::vector<Section>& sections, const std::string& name) {
    if (section.sh_link >= sections.size()) fail("has a damaged symbol table");
    const auto names =
        table<char>(sections[section.sh_link].sh_offset, sections[section.sh_link].sh_size, "table of names");
    for (const auto& symbol : table<Symbol>(section.sh_offset, section.sh_size / sizeof(Symbol), "symbol table")) {
      if (symbol.st_shndx == SHN_UNDEF || symbol.st_name >= names.size()) continue;
      const std::size_t room = names.size() - symbol.st_name;
      if (room > name.size() && std::memcmp(&names[symbol.st_name], name.c_str(), name.size() + 1) == 0) return symbol;
    }
    return std::nullopt;
  }

  std::vector<std::uint8_t> content(const Symbol& symbol, const std::vector<Section>& sections, std::size_t limit) {
    if (symbol.st_shndx >= sections.size()) fail("has a damaged symbol table");
    const Section& home = sections[symbol.st_shndx];
    const bool inside = symbol.st_value >= home.sh_addr && symbol.st_value - home.sh_addr <= home.sh_size;
    if (!inside) fail("has a damaged symbol table");
    const std::uint64_t begin = symbol.st_value - home.sh_addr;
    const std::uint64_t size = std::min<std::uint64_t>({limit, symbol.st_size, home.sh_size - begin});
    if (home.sh_type == SHT_NOBITS) return std::vector<std::uint8_t>(size, 0);  // .bss: all zero
    return table<std::uint8_t>(home.sh_offset + begin, size, "header symbol");
  }

  const ThisMachine here_;
  std::filesystem::path file_;
  std::ifstream stream_;
  std::uint64_t size_ = 0;
  Header header_{};
};

ElfFile::ElfFile(const std::filesystem::path& file) : reader_(std::make_unique<Reader>(file)) {}

ElfFile::~ElfFile() = default;

std::optional<std::vector<std::uint8_t>> ElfFile::symbol(const std::string& name, std::size_t limit) {
  return reader_->symbol(name, limit);
}

}  // namespace dismantle
