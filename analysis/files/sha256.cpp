#include "analysis/files/sha256.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sodium.h>

#include <array>
#include <fstream>
#include <vector>

#include "core/base/error.h"
#include "core/base/file_text.h"

namespace haptrial::analysis {
namespace {

/// Digest of bytes that come in pieces.
class Sha256 {
 public:
  Sha256() { crypto_hash_sha256_init(&state_); }
  void add(const char* bytes, std::size_t count) {
    crypto_hash_sha256_update(&state_, reinterpret_cast<const unsigned char*>(bytes), count);
  }
  std::string text() {
    std::array<unsigned char, crypto_hash_sha256_BYTES> digest{};
    crypto_hash_sha256_final(&state_, digest.data());
    return fmt::format("{:02x}", fmt::join(digest, ""));
  }

 private:
  crypto_hash_sha256_state state_{};
};

}  // namespace

std::string sha256_of(std::string_view text) {
  Sha256 digest;
  digest.add(text.data(), text.size());
  return digest.text();
}

std::string sha256_of_file(const std::filesystem::path& file) {
  constexpr std::size_t kPiece = 1U << 20U;
  refuse_special_file(file);
  std::ifstream in(file, std::ios::binary);
  std::vector<char> piece(kPiece);
  Sha256 digest;
  while (in.read(piece.data(), kPiece) || in.gcount() > 0) {
    digest.add(piece.data(), static_cast<std::size_t>(in.gcount()));
  }
  if (!in.eof()) {
    throw InputError(fmt::format("{}: cannot be read", file.string()));
  }
  return digest.text();
}

}  // namespace haptrial::analysis
