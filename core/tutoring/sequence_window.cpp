#include "core/tutoring/sequence_window.h"

#include <algorithm>

namespace haptrial::tutoring {

bool SequenceWindow::would_accept(std::uint64_t sequence) const noexcept {
  if (sequence == 0) {
    return false;
  }
  return sequence > highest_ || (highest_ - sequence < kSpan && !seen_[sequence % kSpan]);
}

bool SequenceWindow::accept(std::uint64_t sequence) noexcept {
  if (!would_accept(sequence)) {
    return false;
  }
  if (sequence > highest_) {
    const std::uint64_t fresh = std::min(sequence - highest_, kSpan);
    for (std::uint64_t i = 0; i < fresh; ++i) {
      seen_.reset((sequence - i) % kSpan);
    }
    highest_ = sequence;
  }
  seen_.set(sequence % kSpan);
  ++accepted_;
  return true;
}

}  // namespace haptrial::tutoring
