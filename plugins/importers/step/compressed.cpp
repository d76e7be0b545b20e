#include "compressed.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <fstream>
#include <memory>
#include <vector>

#include "dismantle/errors.h"
#include "zip_archive.h"

namespace dismantle::step_import {
namespace {

namespace fs = std::filesystem;

bool begins_with(const fs::path& file, std::string_view bytes) {
  std::ifstream in(file, std::ios::binary);
  std::string head(bytes.size(), '\0');
  return in.read(head.data(), static_cast<std::streamsize>(head.size())) && head == bytes;
}

bool is_gzip(const fs::path& file) { return begins_with(file, "\x1F\x8B"); }

bool is_step_name(const std::string& name) {
  std::string extension = fs::path(name).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension == ".stp" || extension == ".step" || extension == ".p21";
}

std::string from_gzip(const fs::path& file) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> in(gzopen(file.c_str(), "rb"), gzclose_r);
  if (!in) throw InputError(file.string(), "cannot be opened");
  std::error_code ec;
  const std::uint64_t compressed = fs::file_size(file, ec);
  std::string text;
  std::vector<char> block(1 << 16);
  int n = 0;
  while ((n = gzread(in.get(), block.data(), static_cast<unsigned>(block.size()))) > 0) {
    text.append(block.data(), static_cast<std::size_t>(n));
    if (const std::string problem = reader_process::expands_too_much(compressed, text.size()); !problem.empty())
      throw InputError(file.string(), "the compressed file " + problem);
  }
  int error = Z_OK;
  const char* message = gzerror(in.get(), &error);
  if (n < 0 || error != Z_OK)
    throw InputError(file.string(), fmt::format("the compressed file is damaged or cut off ({})", message));
  return text;
}

std::string from_zip(const fs::path& file) {
  reader_process::ZipArchive archive(file, "compressed STEP file");
  std::vector<std::string> names = archive.names();
  std::erase_if(names, [](const std::string& name) { return !is_step_name(name); });
  if (names.size() != 1)
    throw InputError(file.string(), fmt::format("the archive holds {} STEP files: {}", names.size(),
                                                names.empty() ? "there is nothing to read"
                                                              : "unpack it into a folder and name the file to read"));
  std::string text;
  archive.read(names.front(), [&](std::string_view bytes) { text += bytes; });
  return text;
}

}  // namespace

bool is_compressed(const fs::path& file) { return is_gzip(file) || begins_with(file, "PK\x03\x04"); }

std::string unpacked(const fs::path& file) { return is_gzip(file) ? from_gzip(file) : from_zip(file); }

}  // namespace dismantle::step_import
