#include "dismantle/preparation/sha256.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <vector>

#include "dismantle/errors.h"

namespace dismantle {

namespace {

void require(int result) {
  if (result != 1) throw Error("SHA-256 is not available in this OpenSSL");
}

}  // namespace

struct Sha256::Impl {
  EVP_MD_CTX* context = EVP_MD_CTX_new();
  ~Impl() { EVP_MD_CTX_free(context); }
};

Sha256::Sha256() : impl_(std::make_unique<Impl>()) {
  require(impl_->context != nullptr ? EVP_DigestInit_ex(impl_->context, EVP_sha256(), nullptr) : 0);
}

Sha256::~Sha256() = default;

void Sha256::add(std::string_view bytes) { require(EVP_DigestUpdate(impl_->context, bytes.data(), bytes.size())); }

void Sha256::add_file(const std::filesystem::path& file) {
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(file.string(), fmt::format("cannot be opened: {}", std::strerror(errno)));
  std::vector<char> block(1 << 16);
  while (in) {
    in.read(block.data(), static_cast<std::streamsize>(block.size()));
    add({block.data(), static_cast<std::size_t>(in.gcount())});
  }
  if (in.bad()) throw InputError(file.string(), fmt::format("cannot be read: {}", std::strerror(errno)));
}

Sha256Digest Sha256::digest() {
  Sha256Digest digest{};
  require(EVP_DigestFinal_ex(impl_->context, digest.data(), nullptr));
  return digest;
}

std::string Sha256::hex() {
  std::string out;
  for (const unsigned char byte : digest()) out += fmt::format("{:02x}", byte);
  return out;
}

std::string sha256_of_file(const std::filesystem::path& file) {
  Sha256 hash;
  hash.add_file(file);
  return hash.hex();
}

}  // namespace dismantle
