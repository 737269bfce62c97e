#include "core/tutoring/sealer.h"

#include <sodium.h>

#include <cstring>

namespace haptrial::tutoring {
namespace {

constexpr std::size_t kHead = 16;
static_assert(crypto_aead_chacha20poly1305_IETF_ABYTES == 16);
using Nonce = std::array<unsigned char, crypto_aead_chacha20poly1305_IETF_NPUBBYTES>;

Nonce nonce_of(std::uint64_t sequence) noexcept {
  Nonce nonce{};
  std::memcpy(nonce.data() + 4, &sequence, sizeof(sequence));
  return nonce;
}

}  // namespace

SealedBytes Sealer::seal(const TickMessage& message) const noexcept {
  const TickBytes plain = encode(message);
  SealedBytes out(kSealBytes + plain.size());
  std::memcpy(out.data(), &keys_.session, 8);
  std::memcpy(out.data() + 8, &message.sequence, 8);
  crypto_aead_chacha20poly1305_ietf_encrypt(out.data() + kHead, nullptr,
                                            reinterpret_cast<const unsigned char*>(plain.data()),
                                            plain.size(), out.data(), kHead, nullptr,
                                            nonce_of(message.sequence).data(), keys_.send.data());
  return out;
}

std::optional<TickMessage> Opener::open(std::span<const unsigned char> datagram) noexcept {
  const bool of_a_length = datagram.size() == kSealBytes + kTickBytes ||
                           datagram.size() == kSealBytes + kStreamTickBytes;
  if (!of_a_length || std::memcmp(datagram.data(), &keys_.session, 8) != 0) {
    ++counts_.foreign;
    return std::nullopt;
  }
  std::uint64_t sequence = 0;
  std::memcpy(&sequence, datagram.data() + 8, 8);
  if (!window_.would_accept(sequence)) {
    ++counts_.repeated;
    return std::nullopt;
  }
  TickBytes plain(datagram.size() - kSealBytes);
  const int bad = crypto_aead_chacha20poly1305_ietf_decrypt(
      reinterpret_cast<unsigned char*>(plain.data()), nullptr, nullptr, datagram.data() + kHead,
      datagram.size() - kHead, datagram.data(), kHead, nonce_of(sequence).data(),
      keys_.receive.data());
  const std::optional<TickMessage> message = bad == 0 ? decode(plain) : std::nullopt;
  if (!message || message->sequence != sequence) {
    ++counts_.forged;
    return std::nullopt;
  }
  window_.accept(sequence);
  ++counts_.accepted;
  return message;
}

}  // namespace haptrial::tutoring
