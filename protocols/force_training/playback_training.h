#pragma once

#include "protocols/force_training/trajectory_pass.h"

namespace haptrial::protocols {

/// Training by playback: the hand is led along the path by the expert's, with the expert's forces
/// (tutoring::tutoring_force). Nothing is seen of either, or, if it is watched as well, the path,
/// the own tool on it and a blue bar of the target force. Source: Morris 2006, §3.4.1.
class PlaybackTraining final : public TrajectoryPass {
 public:
  PlaybackTraining(const stimulus::Stimulus& stimulus, const GuidanceParameters& parameters,
                   std::int32_t block, bool watched);

 private:
  bool plane_holds() const noexcept override { return false; }
  RunLead run_lead() const noexcept override { return RunLead::kPlayed; }
  void present(stimulus::Presentation& presentation) const noexcept override;

  bool watched_;
};

}  // namespace haptrial::protocols
