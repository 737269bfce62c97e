#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace haptrial::tutoring {

/// How the partner's clock runs beside the own one, from the times of messages that were answered:
/// offset as in NTP (RFC 5905, section 8), from the answer of each second that was under way for
/// the shortest time, since there queues had the least part; drift by a line through those of the
/// last minute. A way that is longer than the way back by d makes the offset wrong by d / 2, which
/// no method can see. While the network changes, answers come by another way than their messages
/// went. So a second is left out if either transit of its answer was more than 5 ms longer than the
/// quickest of that second and its neighbours; of five such seconds in a row the last is taken.
/// Servo thread.
class ClockOffset {
 public:
  /// An answer that has come. All in [ns].
  /// @param sent      own clock, when the own message left
  /// @param heard     partner's clock, when it came
  /// @param answered  partner's clock, when the answer left
  /// @param now       own clock
  void add(std::int64_t sent, std::int64_t heard, std::int64_t answered, std::int64_t now) noexcept;

  bool known() const noexcept { return before_.round_trip >= 0 || best_.round_trip >= 0; }
  /// Partner's clock less the own one at an own time [ns].
  std::int64_t offset(std::int64_t now) const noexcept;
  /// How much faster the partner's clock runs, as a share of the own rate [1]; 0 for the first
  /// three seconds.
  double drift() const noexcept { return drift_; }
  std::int64_t round_trip() const noexcept { return last_round_trip_; }  // of the last answer

 private:
  static constexpr std::size_t kSeconds = 60;
  /// Times between the two clocks: the offset lengthens one and shortens the other.
  struct Transits {
    std::int64_t there{std::numeric_limits<std::int64_t>::max()};
    std::int64_t back{std::numeric_limits<std::int64_t>::max()};
  };
  struct Answer {
    std::int64_t time{0};  // own clock
    std::int64_t offset{0};
    std::int64_t round_trip{-1};  // none yet
    Transits transits;
  };
  void end_second() noexcept;
  bool is_of_one_network(const Answer& answer) const noexcept;
  void fit() noexcept;

  std::array<Answer, kSeconds> kept_{};  // the best of each second, a ring
  std::size_t count_{0};                 // kept in all
  Answer best_;                          // of the present second
  Answer before_;                        // of the second before, which is not judged yet
  std::array<Transits, 3> least_{};  // quickest of the last seconds; the present one is the last
  int left_out_{0};                  // seconds in a row
  std::int64_t second_ends_{0};
  std::int64_t mean_time_{0};  // of the line
  double mean_offset_{0.0};    // of the line, beside the first kept
  std::int64_t base_{0};
  double drift_{0.0};
  std::int64_t last_round_trip_{-1};
};

}  // namespace haptrial::tutoring
