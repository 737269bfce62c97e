#include "core/tutoring/meeting.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "core/base/error.h"
#include "core/tutoring/secret.h"
#include "core/tutoring/waiting_guests.h"

namespace haptrial::tutoring {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kForOne(2);   // message of a handshake
constexpr std::chrono::seconds kForKey(20);  // that the other side makes, on a busy machine

Patience patience_for_one(const MeetingRequest& request, Clock::time_point end) {
  return {std::min(end, Clock::now() + kForOne), request.pulse};
}

Patience patience_for_key(const MeetingRequest& request, Clock::time_point end) {
  return {std::min(end, Clock::now() + kForKey), request.pulse};
}

using Checksums = std::array<unsigned char, 32>;  // four bytes for each shared term
constexpr std::size_t kBytes = Checksums{}.size() / kMostShared;

Checksums checksums_of(const std::vector<SharedTerm>& shared) {
  Checksums all{};
  for (std::size_t i = 0; i < std::min(shared.size(), kMostShared); ++i) {
    const auto sum = checksum_of(shared[i].text);
    std::copy_n(sum.begin(), kBytes, all.begin() + static_cast<std::ptrdiff_t>(i * kBytes));
  }
  return all;
}

/// Names the terms that differ.
void check_study(const LinkTerms& theirs, const MeetingRequest& request) {
  const Checksums own = checksums_of(request.shared);
  if (theirs.study == own) {
    return;
  }
  std::vector<std::string> differ;
  for (std::size_t i = 0; i < request.shared.size(); ++i) {
    const auto place = static_cast<std::ptrdiff_t>(i * kBytes);
    if (!std::equal(own.begin() + place, own.begin() + place + kBytes,
                    theirs.study.begin() + place)) {
      differ.push_back(request.shared[i].name);
    }
  }
  const std::string all =
      differ.empty() ? "kind of study" : fmt::format("{}", fmt::join(differ, ", "));
  throw InputError(
      fmt::format("the other side was started with another {}; both must have the same ones", all));
}

EstablishedLink host(const Secret& secret, const MeetingRequest& request, Clock::time_point end) {
  const Socket listener = listening(request.port);
  Socket datagrams = datagram_socket(request.port);
  Handshake handshake(secret, {port_of(datagrams), checksums_of(request.shared)});
  WaitingGuests guests(listener, handshake.opening(), request.notice);
  while (true) {
    auto guest = guests.next({end, request.pulse});
    if (!guest) {
      throw RunError(fmt::format("nobody came to port {} within {} s", request.port,
                                 request.patience.count()));
    }
    const auto closing = handshake.closing(guest->answer);
    if (!closing) {
      if (request.notice) {
        request.notice("a guest without the secret was turned away");
      }
      continue;
    }
    if (!send_all(guest->socket, *closing, patience_for_one(request, end))) {
      continue;
    }
    check_study(handshake.their_terms(), request);
    guest->from.set_port(handshake.their_terms().port);
    return {std::move(datagrams), guest->from, handshake.keys(), true};
  }
}

void refuse_if_busy(std::span<const unsigned char> message) {
  if (Handshake::is_busy(message)) {
    throw RunError("the other side is busy with other guests; try again in some seconds");
  }
}

EstablishedLink guest(const Secret& secret, const MeetingRequest& request, Clock::time_point end) {
  Address other = address_of(request.guest_of);
  Socket datagrams = datagram_socket(0);
  Handshake handshake(secret, {port_of(datagrams), checksums_of(request.shared)});
  const Socket socket = connected(other, {end, request.pulse});
  Handshake::Opening opening;
  if (!receive_all(socket, opening, patience_for_one(request, end))) {
    throw RunError("the other side did not answer as a host does");
  }
  refuse_if_busy(opening);
  const auto answer = handshake.answer(opening);
  if (!answer) {
    throw RunError("the other side speaks another version of the link");
  }
  Handshake::Closing closing;
  if (!send_all(socket, *answer, patience_for_one(request, end)) ||
      !receive_all(socket, closing, patience_for_key(request, end))) {
    throw RunError("the other side turned this one away: the secrets differ");
  }
  refuse_if_busy(closing);
  if (!handshake.finish(closing)) {
    throw RunError("the other side does not know the secret");
  }
  check_study(handshake.their_terms(), request);
  // The address has the port that was called: a router may hand it on to another number.
  return {std::move(datagrams), other, handshake.keys(), false};
}

}  // namespace

EstablishedLink meet(const Secret& secret, const MeetingRequest& request) {
  const Clock::time_point end = Clock::now() + request.patience;
  return request.guest_of.empty() ? host(secret, request, end) : guest(secret, request, end);
}

}  // namespace haptrial::tutoring
