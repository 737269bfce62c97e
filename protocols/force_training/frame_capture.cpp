#include "protocols/force_training/frame_capture.h"

namespace haptrial::protocols {

FrameCapture::FrameCapture(int frames_per_pass)
    : wanted_(static_cast<std::size_t>(frames_per_pass)) {
  moments_.reserve(wanted_);
}

void FrameCapture::observe(const stimulus::Shown& shown, const stimulus::Forces&, double) noexcept {
  const stimulus::Presentation seen = stimulus::presentation_of(shown);
  const auto count = static_cast<double>(moments_.size());
  const bool runs = seen.progress > 0.0 && seen.progress < 1.0;
  if (runs && moments_.size() < wanted_ &&
      seen.progress >= (count + 0.5) / static_cast<double>(wanted_)) {
    moments_.push_back(seen);
  }
}

std::vector<stimulus::Presentation> FrameCapture::take() {
  std::vector<stimulus::Presentation> taken = moments_;
  moments_.clear();
  return taken;
}

}  // namespace haptrial::protocols
