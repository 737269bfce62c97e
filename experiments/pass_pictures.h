#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "core/render/frames.h"
#include "experiments/frame_capture.h"
#include "experiments/session.h"
#include "protocols/schedule.h"

namespace haptrial::experiments {

/// Pictures of what was shown in each pass, into a folder; nothing where none were asked for.
/// Session's thread; the servo thread speaks to observer().
class PassPictures {
 public:
  explicit PassPictures(const SessionRequest& request);

  /// Sees the pass; null where no pictures are wanted.
  stimulus::Observer* observer() { return renderer_ ? &capture_ : nullptr; }
  /// @param points  the path of the block, p_W (N x 3) [m]
  void set_trajectory(const std::vector<Eigen::Vector3d>& points);
  /// After a pass: its pictures. @throws RunError where one cannot be written.
  void draw(const protocols::PlannedTrial& trial, record::Phase phase);

 private:
  const SessionRequest& request_;
  FrameCapture capture_;
  std::unique_ptr<render::FrameRenderer> renderer_;
};

}  // namespace haptrial::experiments
