#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/tutoring/handshake.h"
#include "core/tutoring/sockets.h"

namespace haptrial::tutoring {

/// A link that may begin: everything that LinkThread needs.
struct EstablishedLink {
  Socket datagrams;
  Address other;  // where its datagrams go
  LinkKeys keys;
  bool follows{false};  // the host: a guest behind a router is where its datagrams come from
};

/// Something that both sides must have alike.
struct SharedTerm {
  std::string name;  // in sentences: "seed"
  std::string text;  // only a checksum of it is told
};

inline constexpr std::size_t kMostShared = 8;

struct MeetingRequest {
  std::string guest_of;            // "name:port" of the host; empty: this side is the host
  std::uint16_t port{7400};        // at which the host listens; its datagrams use the same number
  std::vector<SharedTerm> shared;  // at most kMostShared, in the same order on both sides
  std::chrono::seconds patience{120};
  std::function<void()> pulse;                     // asked ten times a second; may throw
  std::function<void(const std::string&)> notice;  // of guests that were turned away
};

/// Waits for the other side, or goes to it. A host speaks with several guests at once
/// (waiting_guests.h): one without the secret is turned away, one that says nothing is left.
/// @throws InputError where the other side has another study, or is told so; RunError where nobody
///         came in time, nobody listens, the host is busy with others, or it does not know the
///         secret
EstablishedLink meet(const Secret& secret, const MeetingRequest& request);

}  // namespace haptrial::tutoring
