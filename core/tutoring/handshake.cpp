#include "core/tutoring/handshake.h"

#include <sodium.h>

#include <cstring>

#include "core/base/error.h"

namespace haptrial::tutoring {
namespace {

constexpr std::string_view kVersion = "haptrial link 03";
constexpr std::size_t kTermBytes = 34;
constexpr std::size_t kProofBytes = 32;
static_assert(kVersion.size() == 16 && kProofBytes == crypto_auth_BYTES);

using Bytes = std::span<const unsigned char>;

void put_terms(std::span<unsigned char> to, const LinkTerms& terms) {
  to[0] = static_cast<unsigned char>(terms.port & 0xff);
  to[1] = static_cast<unsigned char>(terms.port >> 8);
  std::copy(terms.study.begin(), terms.study.end(), to.begin() + 2);
}

LinkTerms terms_of(Bytes from) {
  LinkTerms terms;
  terms.port = static_cast<std::uint16_t>(from[0] | (from[1] << 8));
  std::copy_n(from.begin() + 2, terms.study.size(), terms.study.begin());
  return terms;
}

bool is_version(Bytes bytes) {
  return std::memcmp(bytes.data(), kVersion.data(), kVersion.size()) == 0;
}

/// A keyed checksum over all messages so far and the role of who sends it.
std::array<unsigned char, kProofBytes> proof(const Secret::Key& key, char role, Bytes opening,
                                             Bytes answer, Bytes closing) {
  std::array<unsigned char, 1 + Handshake::kOpeningBytes + Handshake::kAnswerBytes + kTermBytes>
      said{};
  said[0] = static_cast<unsigned char>(role);
  auto at = std::copy(opening.begin(), opening.end(), said.begin() + 1);
  at = std::copy(answer.begin(), answer.end(), at);
  at = std::copy(closing.begin(), closing.end(), at);
  std::array<unsigned char, kProofBytes> mac{};
  crypto_auth(mac.data(), said.data(), static_cast<std::size_t>(at - said.begin()), key.data());
  return mac;
}

bool same(Bytes a, Bytes b) { return sodium_memcmp(a.data(), b.data(), kProofBytes) == 0; }

}  // namespace

Handshake::Handshake(const Secret& secret, const LinkTerms& terms) : secret_(secret), own_(terms) {
  if (sodium_init() < 0 || crypto_kx_keypair(public_.data(), private_.data()) != 0) {
    throw RunError("the machine gives no random numbers for the keys of a link");
  }
  Secret::Salt salt;
  randombytes_buf(salt.data(), salt.size());
  key_ = secret_.key(salt);
  auto at = std::copy(kVersion.begin(), kVersion.end(), opening_.begin());
  at = std::copy(salt.begin(), salt.end(), at);
  std::copy(public_.begin(), public_.end(), at);
}

Handshake::~Handshake() {
  sodium_memzero(private_.data(), private_.size());
  sodium_memzero(key_.data(), key_.size());
  sodium_memzero(&keys_, sizeof(keys_));
}

std::optional<Handshake::Answer> Handshake::answer(const Opening& opening) {
  if (!is_version(opening)) {
    return std::nullopt;
  }
  opening_ = opening;
  Secret::Salt salt;
  std::copy_n(opening.begin() + 16, salt.size(), salt.begin());
  key_ = secret_.key(salt);
  auto at = std::copy(kVersion.begin(), kVersion.end(), answer_.begin());
  at = std::copy(public_.begin(), public_.end(), at);
  put_terms({at, kTermBytes}, own_);
  const Bytes said = Bytes(answer_).first(kAnswerBytes - kProofBytes);
  const auto mac = proof(key_, 'g', opening_, said, {});
  std::copy(mac.begin(), mac.end(), answer_.end() - kProofBytes);
  return answer_;
}

std::optional<Handshake::Closing> Handshake::closing(const Answer& answer) {
  const Bytes all(answer);
  const Bytes said = all.first(kAnswerBytes - kProofBytes);
  if (!is_version(all) || !same(proof(key_, 'g', opening_, said, {}), all.last(kProofBytes))) {
    return std::nullopt;
  }
  if (!make_keys(Role::kHost, all.subspan<16, 32>())) {
    return std::nullopt;
  }
  theirs_ = terms_of(all.subspan(48, kTermBytes));
  Closing closing{};
  put_terms(std::span(closing).first(kTermBytes), own_);
  const auto mac = proof(key_, 'h', opening_, all, Bytes(closing).first(kTermBytes));
  std::copy(mac.begin(), mac.end(), closing.end() - kProofBytes);
  return closing;
}

bool Handshake::finish(const Closing& closing) {
  const Bytes all(closing);
  const Bytes said = all.first(kTermBytes);
  if (!same(proof(key_, 'h', opening_, answer_, said), all.last(kProofBytes))) {
    return false;
  }
  theirs_ = terms_of(said);
  return make_keys(Role::kGuest, Bytes(opening_).subspan<32, 32>());
}

/// The exchanged keys, each mixed with the key of the secret; the session's number from both.
bool Handshake::make_keys(Role role, std::span<const unsigned char, 32> their_public) {
  std::array<unsigned char, 32> receive{};
  std::array<unsigned char, 32> send{};
  const int bad = role == Role::kHost
                      ? crypto_kx_server_session_keys(receive.data(), send.data(), public_.data(),
                                                      private_.data(), their_public.data())
                      : crypto_kx_client_session_keys(receive.data(), send.data(), public_.data(),
                                                      private_.data(), their_public.data());
  if (bad != 0) {
    return false;  // a public key that makes the exchange foreseeable
  }
  const auto mixed = [&](const std::array<unsigned char, 32>& key) {
    std::array<unsigned char, 32> out{};
    crypto_generichash(out.data(), out.size(), key.data(), key.size(), key_.data(), key_.size());
    return out;
  };
  keys_.send = mixed(send);
  keys_.receive = mixed(receive);
  const auto& up = role == Role::kHost ? keys_.receive : keys_.send;
  std::array<unsigned char, 32> name{};
  crypto_generichash(name.data(), name.size(), up.data(), up.size(), nullptr, 0);
  std::memcpy(&keys_.session, name.data(), sizeof(keys_.session));
  return true;
}

}  // namespace haptrial::tutoring
