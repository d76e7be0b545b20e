#include "store/compress.h"

#include <zlib.h>

#include "dismantle/errors.h"

namespace dismantle::bench {

std::string compressed(std::string_view bytes) {
  uLongf size = compressBound(bytes.size());
  std::string out(size, '\0');
  if (compress(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
               bytes.size()) != Z_OK)
    throw Error("a plan cannot be compressed");
  out.resize(size);
  return out;
}

std::string expanded(std::string_view bytes, std::size_t size) {
  // Deflate expands one byte to at most 1032. Impossible sizes are rejected before memory is allocated for them.
  if (size / 1032 > bytes.size()) throw Error("the compressed plan of a row is damaged");
  std::string out(size, '\0');
  uLongf length = size;
  if (uncompress(reinterpret_cast<Bytef*>(out.data()), &length, reinterpret_cast<const Bytef*>(bytes.data()),
                 bytes.size()) != Z_OK ||
      length != size)
    throw Error("the compressed plan of a row is damaged");
  return out;
}

}  // namespace dismantle::bench
