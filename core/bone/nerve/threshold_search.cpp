#include "core/bone/nerve/threshold_search.h"

#include <cmath>

namespace haptrial::nerve {

void ThresholdSearch::tell(bool answered) noexcept {
  constexpr double kClose = 1.05;
  if (done_) {
    return;
  }
  const int pulse = told_++;
  if (pulse == 0 && !answered) {
    done_ = out_of_range_ = true;  // not even the strongest
    return;
  }
  if (pulse == 0) {
    next_ = low_;
    return;
  }
  if (pulse == 1 && answered) {
    high_ = low_;
    done_ = out_of_range_ = true;
    return;
  }
  (answered ? high_ : low_) = next_;
  next_ = std::sqrt(low_ * high_);
  done_ = high_ <= kClose * low_;
}

}  // namespace haptrial::nerve
