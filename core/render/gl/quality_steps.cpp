#include "core/render/gl/quality_steps.h"

#include <algorithm>

namespace haptrial::render {
namespace {

// Mean interval from which on it is too much [s]: every other refresh of 60 Hz is often enough.
constexpr double kSlow = 1.0 / 29.5;
constexpr double kFast = 1.0 / 45.0;  // below which more may fit [s]
constexpr double kPause = 0.5;        // an interval that says nothing: nothing was shown [s]
constexpr int kFewFrames = 30;
constexpr int kManyFrames = 90;
constexpr int kMostPatience = 64;

}  // namespace

void QualitySteps::step(int by) noexcept {
  now_ = static_cast<Quality>(static_cast<int>(now_) + by);
  frames_ = 0;
  sum_ = 0.0;
}

Quality QualitySteps::next(double interval) noexcept {
  if (!(interval > 0.0) || interval > kPause) {
    return now_;
  }
  ++frames_;
  sum_ += interval;
  const double mean = sum_ / frames_;
  if (frames_ == kFewFrames && mean > kSlow && now_ != Quality::kPlain) {
    patience_ = tried_ ? std::min(2 * patience_, kMostPatience) : patience_;
    tried_ = false;
    step(-1);
  } else if (frames_ % kFewFrames == 0 && mean > kFast) {
    frames_ = 0;
    sum_ = 0.0;
  } else if (frames_ >= patience_ * kManyFrames && now_ != most_) {
    tried_ = true;
    step(1);
  }
  return now_;
}

}  // namespace haptrial::render
