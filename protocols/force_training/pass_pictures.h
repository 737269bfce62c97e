#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "core/record/rows/session_types.h"
#include "core/render/flat/trial_display.h"
#include "core/stimulus/observer.h"
#include "core/stimulus/presentation.h"
#include "protocols/interface/trials.h"

namespace haptrial::protocols {

/// Keeps what was presented at evenly spaced moments of each run, to be drawn after the pass.
class FrameCapture final : public stimulus::Observer {
 public:
  explicit FrameCapture(int frames_per_pass);
  void observe(const stimulus::Shown& shown, const stimulus::Forces& forces,
               double dt) noexcept override;
  /// The moments of the last pass; call between passes. Makes room for the next one.
  std::vector<stimulus::Presentation> take();

 private:
  std::vector<stimulus::Presentation> moments_;  // capacity set at construction
  std::size_t wanted_;
};

/// Pictures of what was shown in each pass, into a folder; nothing where none were asked for.
/// Session's thread; the servo thread speaks to observer().
class PassPictures {
 public:
  /// @param place  outlives the pictures
  PassPictures(const render::TrialDisplayStyle& style, const SessionPlace& place);

  /// Sees the pass; null where no pictures are wanted.
  stimulus::Observer* observer() { return renderer_ ? &capture_ : nullptr; }
  /// @param points  the path of the block, p_W (N x 3) [m]
  void set_trajectory(const std::vector<Eigen::Vector3d>& points);
  /// Draws the pictures of a pass that has ended. @throws RunError where one cannot be written.
  void draw(const PlannedTrial& trial, const record::Phase& phase);

 private:
  const SessionPlace& place_;
  FrameCapture capture_;
  std::unique_ptr<render::FrameRenderer> renderer_;
};

}  // namespace haptrial::protocols
