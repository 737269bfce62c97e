#pragma once

#include <vector>

#include "core/stimulus/observer.h"
#include "core/stimulus/presentation.h"

namespace haptrial::protocols {

/// Keeps what was presented at evenly spaced moments of each run, to be drawn after the pass.
class FrameCapture final : public stimulus::Observer {
 public:
  explicit FrameCapture(int frames_per_pass);
  void observe(const stimulus::Shown& shown, const stimulus::Forces& forces, double dt) noexcept override;
  /// The moments of the last pass; call between passes. Makes room for the next one.
  std::vector<stimulus::Presentation> take();

 private:
  std::vector<stimulus::Presentation> moments_;  // capacity set at construction
  std::size_t wanted_;
};

}  // namespace haptrial::protocols
