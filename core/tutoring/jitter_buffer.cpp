#include "core/tutoring/jitter_buffer.h"

#include <algorithm>
#include <cmath>

namespace haptrial::tutoring {

/// The transit of a message is known up to the offset of the clocks, which cancels.
void JitterBuffer::measure(std::int64_t transit) noexcept {
  constexpr std::uint64_t kEvery = 64;  // messages between two choices of the delay
  transits_[measured_++ % kMeasured] = transit;
  if (measured_ != 1 && measured_ % kEvery != 0) {
    return;
  }
  const std::size_t n = std::min<std::size_t>(measured_, kMeasured);
  std::copy_n(transits_.begin(), n, sorted_.begin());
  const auto at = static_cast<std::size_t>(
      std::ceil((1.0 - std::clamp(late_, 0.0, 1.0)) * static_cast<double>(n - 1)));
  std::nth_element(sorted_.begin(), sorted_.begin() + static_cast<std::ptrdiff_t>(at),
                   sorted_.begin() + static_cast<std::ptrdiff_t>(n));
  quickest_ = *std::min_element(sorted_.begin(), sorted_.begin() + static_cast<std::ptrdiff_t>(n));
  delay_ = std::clamp<std::int64_t>(sorted_[at] - quickest_, 0, most_);
}

void JitterBuffer::put(const TickMessage& message, std::int64_t now) noexcept {
  measure(now - message.sent_ns);
  if (message.sequence <= out_ || message.sequence + kMost <= highest_) {
    return;  // a newer one was given out
  }
  waiting_[message.sequence % kMost] = message;
  highest_ = std::max(highest_, message.sequence);
}

const TickMessage* JitterBuffer::take(std::int64_t now) noexcept {
  const std::uint64_t oldest = highest_ >= kMost ? highest_ - kMost + 1 : 1;
  for (std::uint64_t next = std::max(out_ + 1, oldest); next <= highest_; ++next) {
    const TickMessage& message = waiting_[next % kMost];
    if (message.sequence != next) {
      continue;  // it has not come
    }
    if (message.sent_ns + quickest_ + delay_ > now) {
      break;
    }
    given_ = message;
    out_ = next;
  }
  return out_ > 0 ? &given_ : nullptr;
}

}  // namespace haptrial::tutoring
