#include "experiments/runner/participant_input.h"

namespace haptrial::experiments {

std::vector<InputNews> ParticipantInput::take_news(device::Gamepad* pad) {
  std::vector<InputNews> all = pedal.take_news();
  if (pad != nullptr) {
    const std::vector<InputNews> more = pad_losses_.take(pad->input(), pad->take_changes());
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

std::vector<std::string> ParticipantInput::losses(device::Gamepad* pad) const {
  std::vector<std::string> sentences{pedal.losses()};
  if (pad != nullptr) {
    sentences.push_back(pad_losses_.sentence(pad->input()));
  }
  return sentences;
}

}  // namespace haptrial::experiments
