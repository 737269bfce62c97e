#include "core/tutoring/secret.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sodium.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>

#include "core/base/error.h"
#include "core/base/file_text.h"

namespace haptrial::tutoring {
namespace {

static_assert(sizeof(Secret::Salt) == crypto_pwhash_SALTBYTES);

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(kSpace);
  return begin == std::string_view::npos
             ? std::string_view()
             : text.substr(begin, text.find_last_not_of(kSpace) - begin + 1);
}

}  // namespace

Secret Secret::read(const std::filesystem::path& file) {
  using std::filesystem::perms;
  std::string text = file_text(file);
  const perms others = perms::group_all | perms::others_all;
  if ((std::filesystem::status(file).permissions() & others) != perms::none) {
    throw InputError(fmt::format(
        "{}: other users of this machine may read the secret; allowed: a file of your own (chmod "
        "600 {})",
        file.string(), file.string()));
  }
  Secret secret(trimmed(text), file.string());
  sodium_memzero(text.data(), text.size());
  return secret;
}

void Secret::make(const std::filesystem::path& file) {
  if (sodium_init() < 0) {
    throw RunError("the machine gives no random numbers for a secret");
  }
  std::array<unsigned char, 32> bits{};
  randombytes_buf(bits.data(), bits.size());
  std::array<char, 2 * 32 + 1> text{};
  sodium_bin2hex(text.data(), text.size(), bits.data(), bits.size());
  text.back() = '\n';
  const int fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
  int why = errno;
  bool kept = false;
  if (fd >= 0) {
    const ssize_t written = ::write(fd, text.data(), text.size());
    why = written < 0 ? errno : ENOSPC;
    kept = written == ssize_t{2 * 32 + 1};
    ::close(fd);
    if (!kept) {
      ::unlink(file.c_str());  // so that the next try can make it
    }
  }
  sodium_memzero(bits.data(), bits.size());
  sodium_memzero(text.data(), text.size());
  const std::string sentence =
      fmt::format("{}: the secret cannot be written ({})", file.string(), std::strerror(why));
  if (fd < 0) {
    throw InputError(sentence);
  }
  if (!kept) {
    throw RunError(sentence);
  }
}

std::array<unsigned char, 32> checksum_of(std::string_view text) {
  std::array<unsigned char, 32> sum{};
  crypto_generichash(sum.data(), sum.size(), reinterpret_cast<const unsigned char*>(text.data()),
                     text.size(), nullptr, 0);
  return sum;
}

Secret::Secret(std::string_view text, std::string_view where) : size_(text.size()) {
  if (text.size() < kLeast || text.size() > text_.size()) {
    throw InputError(fmt::format("{}: the secret has {} characters; allowed: {} to {}", where,
                                 text.size(), kLeast, text_.size()));
  }
  std::copy(text.begin(), text.end(), text_.begin());
}

Secret::~Secret() { sodium_memzero(text_.data(), text_.size()); }

Secret::Key Secret::key(const Salt& salt) const {
  Key key;
  if (sodium_init() < 0 ||
      crypto_pwhash(key.data(), key.size(), text_.data(), size_, salt.data(),
                    crypto_pwhash_OPSLIMIT_INTERACTIVE, crypto_pwhash_MEMLIMIT_INTERACTIVE,
                    crypto_pwhash_ALG_ARGON2ID13) != 0) {
    throw RunError("there is not enough memory (64 MB) to make a key of the secret");
  }
  return key;
}

}  // namespace haptrial::tutoring
