#include "core/tutoring/waiting_guests.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <span>
#include <utility>

namespace haptrial::tutoring {
namespace {

/// This much fits into the buffer of a connection that carried little before.
bool send_at_once(const Socket& to, std::span<const unsigned char> bytes) noexcept {
  return ::send(to.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL) ==
         static_cast<ssize_t>(bytes.size());
}

}  // namespace

WaitingGuests::WaitingGuests(const Socket& listener, const Handshake::Opening& opening,
                             Notice notice)
    : listener_(listener), opening_(opening), notice_(std::move(notice)) {}

WaitingGuests::~WaitingGuests() {
  for (const PendingPeer& guest : guests_) {
    send_at_once(guest.said.socket, Handshake::busy<Handshake::Closing>());
  }
}

std::optional<WaitingGuests::AnsweredGuest> WaitingGuests::next(const Patience& patience) {
  while (Clock::now() < patience.until) {
    wait(patience);
    const auto whole = std::ranges::find_if(
        guests_, [](const PendingPeer& guest) { return guest.heard == Handshake::kAnswerBytes; });
    if (whole != guests_.end()) {
      AnsweredGuest answered = std::move(whole->said);
      guests_.erase(whole);
      return answered;
    }
    leave_silent();
  }
  return std::nullopt;
}

/// Waits until somebody comes or speaks, and no longer than a tenth of a second.
void WaitingGuests::wait(const Patience& patience) {
  using namespace std::chrono;
  constexpr milliseconds kPulse(100);
  std::vector<pollfd> watched{{listener_.get(), POLLIN, 0}};
  for (const PendingPeer& guest : guests_) {
    watched.push_back({guest.said.socket.get(), POLLIN, 0});
  }
  const auto left = ceil<milliseconds>(patience.until - Clock::now());
  const auto longest = std::clamp(left, milliseconds(0), kPulse);
  if (::poll(watched.data(), watched.size(), static_cast<int>(longest.count())) > 0) {
    for (std::size_t i = 0; i < guests_.size(); ++i) {
      if (watched[i + 1].revents != 0) {
        hear(guests_[i]);
      }
    }
    if (watched[0].revents != 0) {
      let_in();
    }
  }
  if (patience.pulse && Clock::now() - pulsed_ >= kPulse) {
    pulsed_ = Clock::now();
    patience.pulse();
  }
}

void WaitingGuests::let_in() {
  constexpr std::chrono::seconds kForAnswer(5);  // a guest makes a key first
  PendingPeer guest;
  const Patience patience{Clock::now() + std::chrono::milliseconds(100), {}};  // it is there
  guest.said.socket = accepted(listener_, patience, &guest.said.from);
  if (guest.said.socket.get() < 0) {
    return;
  }
  guest.until = Clock::now() + kForAnswer;
  guest.gone = !send_at_once(guest.said.socket, opening_);
  guests_.push_back(std::move(guest));  // the last of them has waited least
  if (guests_.size() > kMost) {
    make_room();
  }
}

void WaitingGuests::make_room() {
  const auto from_there = [&](const PendingPeer& guest) {
    return std::ranges::count_if(guests_, [&](const PendingPeer& other) {
      return same_machine(guest.said.from, other.said.from);
    });
  };
  const auto crowd = std::ranges::max_element(guests_, {}, from_there);  // the first of several
  send_at_once(crowd->said.socket, Handshake::busy<Handshake::Closing>());
  guests_.erase(crowd);
  say("a guest was told that this side is busy");
}

void WaitingGuests::hear(PendingPeer& guest) {
  const auto room = std::span(guest.said.answer).subspan(guest.heard);
  const ssize_t got = ::recv(guest.said.socket.get(), room.data(), room.size(), 0);
  if (got > 0) {
    guest.heard += static_cast<std::size_t>(got);
  } else {
    guest.gone = got == 0 || errno != EAGAIN;
  }
}

void WaitingGuests::leave_silent() {
  const auto now = Clock::now();
  const auto left = std::erase_if(
      guests_, [&](const PendingPeer& guest) { return guest.gone || now >= guest.until; });
  for (std::size_t i = 0; i < left; ++i) {
    say("a guest that did not speak was turned away");
  }
}

void WaitingGuests::say(const char* notice) const {
  if (notice_) {
    notice_(notice);
  }
}

}  // namespace haptrial::tutoring
