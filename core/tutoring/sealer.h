#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/tutoring/handshake.h"
#include "core/tutoring/sequence_window.h"
#include "core/tutoring/tick_message.h"

namespace haptrial::tutoring {

/// A datagram: session, sequence number, the message enciphered, and what authenticates all of it.
inline constexpr std::size_t kSealBytes = 8 + 8 + 16;
inline constexpr std::size_t kMostSealedBytes = kSealBytes + kStreamTickBytes;
using SealedBytes = Packet<unsigned char, kMostSealedBytes>;

/// Puts messages under ChaCha20-Poly1305 (RFC 8439, by libsodium). The number of a message is its
/// nonce: never seal two with the same one. One thread.
class Sealer {
 public:
  explicit Sealer(const LinkKeys& keys) noexcept : keys_(keys) {}
  SealedBytes seal(const TickMessage& message) const noexcept;

 private:
  LinkKeys keys_;
};

/// Opens them. What is not this session's, not of who knows the secret, or came before, is dropped
/// and counted; how much a flood costs is the check of 16 bytes, or one decipherment. One thread.
class Opener {
 public:
  explicit Opener(const LinkKeys& keys) noexcept : keys_(keys) {}
  std::optional<TickMessage> open(std::span<const unsigned char> datagram) noexcept;

  struct Counts {
    std::uint64_t accepted{0};
    std::uint64_t foreign{0};   // another length or session
    std::uint64_t forged{0};    // not authentic, or without sense
    std::uint64_t repeated{0};  // or too old to tell
  };
  const Counts& counts() const noexcept { return counts_; }

 private:
  LinkKeys keys_;
  SequenceWindow window_;
  Counts counts_;
};

}  // namespace haptrial::tutoring
