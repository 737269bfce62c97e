#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "core/tutoring/secret.h"

namespace haptrial::tutoring {

/// Keys of two sides that have shown each other that they know the secret.
struct LinkKeys {
  std::array<unsigned char, 32> send{};
  std::array<unsigned char, 32> receive{};
  std::uint64_t session{0};  // both the same; new each time
};

/// Terms that each side tells the other beside: they are shown to come from a side that knows the
/// secret.
struct LinkTerms {
  std::uint16_t port{0};                  // for datagrams
  std::array<unsigned char, 32> study{};  // checksum of what both must have alike
};

/// How a link begins: three messages over a connection that nobody else need be kept from.
///
///     host  -> guest   version, salt, public key
///     guest -> host    version, public key, terms, proof
///     host  -> guest   terms, proof
///
/// A host that speaks with too many others, or has let another in, says that it is busy in place of
/// its message.
///
/// A proof is a keyed checksum (the key made of secret and salt) over all that was said before, in
/// the teller's role; the keys of the link come from the exchange of public keys (X25519) and from
/// the secret, so that a recording of a link stays closed even if the secret is found later.
/// Primitives: libsodium.
class Handshake {
 public:
  enum class Role : std::uint8_t { kHost, kGuest };
  static constexpr std::size_t kOpeningBytes = 16 + 16 + 32;
  static constexpr std::size_t kAnswerBytes = 16 + 32 + 34 + 32;
  static constexpr std::size_t kClosingBytes = 34 + 32;
  using Opening = std::array<unsigned char, kOpeningBytes>;
  using Answer = std::array<unsigned char, kAnswerBytes>;
  using Closing = std::array<unsigned char, kClosingBytes>;

  /// A host says this in place of its opening or closing if it has no time for a guest.
  template <class Message>
  static Message busy() noexcept {
    Message message{};
    std::copy_n(kBusy.begin(), kBusy.size(), message.begin());
    return message;
  }
  static bool is_busy(std::span<const unsigned char> message) noexcept {
    return std::equal(kBusy.begin(), kBusy.end(), message.begin());
  }

  /// @throws RunError without random numbers
  Handshake(const Secret& secret, const LinkTerms& terms);
  ~Handshake();
  Handshake(const Handshake&) = delete;
  Handshake& operator=(const Handshake&) = delete;

  /// Host. The same for every guest that tries.
  const Opening& opening() const noexcept { return opening_; }
  /// PendingPeer. @returns nothing where the opening is not one of this version.
  std::optional<Answer> answer(const Opening& opening);
  /// Host. @returns nothing where the guest does not know the secret; the next may try.
  std::optional<Closing> closing(const Answer& answer);
  /// PendingPeer. @returns whether the host knows the secret.
  bool finish(const Closing& closing);

  /// Terms of the other side; call after closing() or finish().
  const LinkTerms& their_terms() const noexcept { return theirs_; }
  const LinkKeys& keys() const noexcept { return keys_; }

 private:
  static constexpr std::string_view kBusy = "haptrial busy 01";

  bool make_keys(Role role, std::span<const unsigned char, 32> their_public);

  const Secret& secret_;
  LinkTerms own_;
  LinkTerms theirs_;
  LinkKeys keys_;
  std::array<unsigned char, 32> public_{};
  std::array<unsigned char, 32> private_{};
  Secret::Key key_{};  // of secret and salt
  Opening opening_{};
  Answer answer_{};
};

}  // namespace haptrial::tutoring
