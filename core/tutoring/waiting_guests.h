#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/tutoring/handshake.h"
#include "core/tutoring/sockets.h"

namespace haptrial::tutoring {

/// The guests with whom a host speaks at once, so that one that says nothing holds up nobody. Each
/// has five seconds for its answer. When there are too many, the one that has waited longest of the
/// address with the most guests is told that the host is busy, and so is who is left at the end.
/// One thread.
class WaitingGuests {
 public:
  static constexpr std::size_t kMost = 32;
  using Notice = std::function<void(const std::string&)>;

  struct AnsweredGuest {
    Socket socket;
    Address from;
    Handshake::Answer answer{};
  };

  /// @param listener, opening  outlive this  @param notice  of guests that were turned away
  WaitingGuests(const Socket& listener, const Handshake::Opening& opening, Notice notice);
  ~WaitingGuests();
  WaitingGuests(const WaitingGuests&) = delete;
  WaitingGuests& operator=(const WaitingGuests&) = delete;

  /// The next guest that has said its whole answer; nothing at the end of the patience.
  std::optional<AnsweredGuest> next(const Patience& patience);

 private:
  using Clock = std::chrono::steady_clock;
  struct PendingPeer {
    AnsweredGuest said;
    std::size_t heard{0};  // bytes of the answer
    Clock::time_point until;
    bool gone{false};
  };

  void wait(const Patience& patience);
  void let_in();
  void make_room();
  void hear(PendingPeer& guest);
  void leave_silent();
  void say(const char* notice) const;

  const Socket& listener_;
  const Handshake::Opening& opening_;
  Notice notice_;
  std::vector<PendingPeer> guests_;
  Clock::time_point pulsed_{};
};

}  // namespace haptrial::tutoring
