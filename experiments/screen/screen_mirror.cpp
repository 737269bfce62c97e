#include "experiments/screen/screen_mirror.h"

#include "core/render/gl/image.h"
#include "experiments/screen/screen.h"

namespace haptrial::experiments {

std::string ScreenMirror::picture() {
  const std::lock_guard lock(mutex_);
  const auto now = std::chrono::steady_clock::now();
  if (picture_.empty() || now - taken_ >= kPeriod) {
    const render::Image image = screen_.screenshot();
    const int times = (image.width + kWidth - 1) / kWidth;
    picture_ = render::png_bytes(render::coarser(image, times));
    taken_ = now;
  }
  return picture_;
}

}  // namespace haptrial::experiments
