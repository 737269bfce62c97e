#include "protocols/force_training/training_pass.h"

#include <stdexcept>

#include "protocols/force_training/haptic_training.h"
#include "protocols/force_training/playback_training.h"
#include "protocols/force_training/visual_training.h"
#include "protocols/force_training/visuohaptic_training.h"
#include "protocols/force_training/watching_training.h"

namespace haptrial::protocols {

const std::vector<std::string>& training_conditions() {
  static const std::vector<std::string> conditions{"haptic",  "visual",  "visuohaptic",
                                                   kWatching, kPlayback, kWatchedPlayback};
  return conditions;
}

bool has_expert(const std::string& condition) {
  return condition == kWatching || condition == kPlayback || condition == kWatchedPlayback;
}

std::unique_ptr<TrajectoryPass> make_training_pass(const std::string& condition,
                                                   const stimulus::Stimulus& stimulus,
                                                   const GuidanceParameters& parameters,
                                                   std::int32_t block) {
  if (condition == "haptic") {
    return std::make_unique<HapticTraining>(stimulus, parameters, block);
  }
  if (condition == "visual") {
    return std::make_unique<VisualTraining>(stimulus, parameters, block);
  }
  if (condition == "visuohaptic") {
    return std::make_unique<VisuohapticTraining>(stimulus, parameters, block);
  }
  if (condition == kWatching) {
    return std::make_unique<WatchingTraining>(stimulus, parameters, block);
  }
  if (has_expert(condition)) {
    return std::make_unique<PlaybackTraining>(stimulus, parameters, block,
                                              condition == kWatchedPlayback);
  }
  throw std::invalid_argument("no training condition '" + condition + "'");
}

}  // namespace haptrial::protocols
