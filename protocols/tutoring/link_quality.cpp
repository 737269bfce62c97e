#include "protocols/tutoring/link_quality.h"

#include <algorithm>
#include <cmath>

namespace haptrial::protocols {

void LinkQuality::hear(const tutoring::Arrived& arrived) noexcept {
  constexpr double kShare = 1.0 / 16.0;  // of the newest, as in RFC 3550
  const std::int64_t transit = arrived.time_ns - arrived.message.sent_ns;
  if (begun_) {
    const double change = 1e-9 * std::abs(static_cast<double>(transit - transit_));
    jitter_ += kShare * (change - jitter_);
  }
  transit_ = transit;
  begun_ = true;
}

void LinkQuality::step(const tutoring::SequenceWindow& window, std::int64_t now_ns) noexcept {
  constexpr std::int64_t kSecond = 1'000'000'000;
  if (now_ns < second_ends_) {
    return;
  }
  const std::uint64_t sent = window.highest() - highest_;
  const std::uint64_t came = window.accepted() - accepted_;
  const bool first = second_ends_ == 0;
  loss_ = first || sent == 0
              ? 0.0
              : std::clamp(1.0 - static_cast<double>(came) / static_cast<double>(sent), 0.0, 1.0);
  highest_ = window.highest();
  accepted_ = window.accepted();
  second_ends_ = now_ns + kSecond;
}

}  // namespace haptrial::protocols
