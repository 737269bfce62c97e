#pragma once

#include <array>
#include <filesystem>
#include <string_view>

namespace haptrial::tutoring {

/// The secret that both sides of a link know and nobody else: the text of a small file that each
/// keeps for itself. The secret never goes into a file of results, a log or a message, and its
/// memory is wiped.
class Secret {
 public:
  static constexpr std::size_t kLeast = 16;  // characters

  /// The text of a file, without white space at its ends.
  /// @throws InputError where it cannot be read, is shorter than kLeast or longer than 1024
  ///         characters, or may be read by other users of the machine
  static Secret read(const std::filesystem::path& file);
  /// A new file with a secret of 256 random bits, which only its owner may read.
  /// @throws InputError where the file exists or cannot be made; RunError where it cannot be
  ///         written, which leaves no file, or the machine gives no random numbers
  static void make(const std::filesystem::path& file);
  /// @throws InputError for a text that is too short or too long. @param where  for the message
  Secret(std::string_view text, std::string_view where);
  Secret(const Secret&) = default;
  Secret& operator=(const Secret&) = default;
  ~Secret();

  using Salt = std::array<unsigned char, 16>;
  using Key = std::array<unsigned char, 32>;
  /// Slow on purpose (about a tenth of a second, 64 MB), so that a short secret is not soon
  /// guessed.
  /// @throws RunError without that memory
  Key key(const Salt& salt) const;

 private:
  std::array<char, 1024> text_{};
  std::size_t size_{0};
};

/// Tells whether both sides have the same text (BLAKE2b).
std::array<unsigned char, 32> checksum_of(std::string_view text);

}  // namespace haptrial::tutoring
