/// The handshake between a plugin file and the host: one plain struct, readable from the bytes of the
/// file before any code of the plugin runs. Version policy: docs/abi.md.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <version>  // defines the standard library's own macros

namespace dismantle {

/// Major: any change of a boundary type's layout, of a vtable, or of the meaning of a call.
/// Minor: functions appended to what the host provides, or fields appended to PluginHeader.
inline constexpr std::uint16_t kPluginApiMajor = 6;
/// Raised when the host offers more to plugins; older plugins stay valid.
inline constexpr std::uint16_t kPluginApiMinor = 0;
inline constexpr std::uint32_t kPluginMagic = 0x4c504d44;  ///< "DMPL" in a little-endian file
/// Name of the struct that a plugin exports.
inline constexpr char kPluginHeaderSymbol[] = "dismantle_plugin_header";

/// Exported as `dismantle_plugin_header`. Strings are stored inside, not pointed to, so that the host
/// can read them without the dynamic linker. All are terminated by a zero.
struct PluginHeader {
  std::uint32_t magic = 0;
  std::uint32_t header_size = 0;  ///< sizeof(PluginHeader) as the plugin saw it; a later minor may append fields
  std::uint16_t api_major = 0;
  std::uint16_t api_minor = 0;
  char abi_tag[256] = {};  ///< "key=value;key=value;...": compared item by item
  char id[64] = {};
  char version[32] = {};
  char licence[64] = {};
  char url[160] = {};
  /// Fills the Registrar behind the pointer. 0 = done; otherwise `message` (of `size` bytes) says what
  /// went wrong. Never throws.
  int (*register_types)(void* registrar, char* message, std::size_t size) noexcept = nullptr;
};

namespace abi {

/// Text of fixed capacity, built at compile time.
struct Text {
  char data[256] = {};
  std::size_t size = 0;

  constexpr void add(const char* s) {
    for (; *s != '\0'; ++s) add(*s);
  }
  constexpr void add(char c) {
    if (size + 1 >= sizeof(data)) throw "ABI tag too long";
    data[size++] = c;
  }
  constexpr void add(std::uint64_t n, unsigned base = 10) {
    char digits[20] = {};
    int count = 0;
    do {
      digits[count++] = "0123456789abcdef"[n % base];
      n /= base;
    } while (n != 0);
    while (count > 0) add(digits[--count]);
  }
  constexpr void item(const char* key, const char* value) { add(key), add('='), add(value), add(';'); }
  constexpr void item(const char* key, std::uint64_t value, unsigned base = 10) {
    add(key), add('='), add(value, base), add(';');
  }
};

/// FNV-1a over size and alignment of every type that crosses the boundary.
template <class... Types>
constexpr std::uint64_t layout_hash() {
  std::uint64_t hash = 0xcbf29ce484222325u;
  const auto mix = [&hash](std::uint64_t n) {
    for (int byte = 0; byte < 8; ++byte) hash = (hash ^ ((n >> (8 * byte)) & 0xffu)) * 0x100000001b3u;
  };
  ((mix(sizeof(Types)), mix(alignof(Types))), ...);
  return hash;
}

/// The compile settings of this translation unit that must agree between binaries.
constexpr Text make_tag(std::uint64_t layout) {
  Text tag;
#if defined(__GXX_ABI_VERSION) && __GXX_ABI_VERSION >= 1002
  tag.item("cxx_abi", "itanium");
#else
  tag.item("cxx_abi", "unknown");
#endif
#if defined(__GLIBCXX__)
  tag.item("stdlib", "libstdc++");
  tag.item("cxx11_strings", static_cast<std::uint64_t>(_GLIBCXX_USE_CXX11_ABI));
#elif defined(_LIBCPP_VERSION)
  tag.item("stdlib", "libc++");
  tag.item("cxx11_strings", std::uint64_t{_LIBCPP_ABI_VERSION});
#else
  tag.item("stdlib", "unknown");
#endif
#if defined(_GLIBCXX_DEBUG)
  tag.item("stdlib_debug", "on");
#else
  tag.item("stdlib_debug", "off");
#endif
  tag.add("eigen=");
  tag.add(std::uint64_t{EIGEN_WORLD_VERSION}), tag.add('.');
  tag.add(std::uint64_t{EIGEN_MAJOR_VERSION}), tag.add('.');
  tag.add(std::uint64_t{EIGEN_MINOR_VERSION}), tag.add(';');
  tag.item("eigen_max_align_bytes", std::uint64_t{EIGEN_MAX_ALIGN_BYTES});
#if defined(EIGEN_DEFAULT_TO_ROW_MAJOR)
  tag.item("eigen_storage", "row_major");
#else
  tag.item("eigen_storage", "column_major");
#endif
  tag.item("pointer_bits", 8 * sizeof(void*));
  tag.item("layout", layout, 16);
  return tag;
}

/// Copies a string into a field of the header; a string that does not fit does not compile.
template <std::size_t N>
constexpr void put(char (&field)[N], const char* text) {
  std::size_t i = 0;
  for (; text[i] != '\0'; ++i) {
    if (i + 1 >= N) throw "text too long for the plugin header";
    field[i] = text[i];
  }
}

}  // namespace abi
}  // namespace dismantle
