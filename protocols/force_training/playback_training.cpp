#include "protocols/force_training/playback_training.h"

namespace haptrial::protocols {

PlaybackTraining::PlaybackTraining(const stimulus::Stimulus& stimulus,
                                   const GuidanceParameters& parameters, std::int32_t block,
                                   bool watched)
    : TrajectoryPass(stimulus, parameters, block), watched_(watched) {}

void PlaybackTraining::present(stimulus::Presentation& presentation) const noexcept {
  presentation.instruction = stimulus::Instruction::kFollow;
  presentation.show_trajectory = watched_;
  presentation.show_target_bar = watched_;
}

}  // namespace haptrial::protocols
