#include "experiments/runner/participant_input.h"

#include <fmt/format.h>

#include "core/base/error.h"

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

using protocols::PedalUse;

SessionPedal::SessionPedal(const DeviceChoice& device, const protocols::Definition& d, bool real) {
  const PedalUse use = d.pedal_use();
  const bool person = device.name != "virtual" && !replayed_file(device.name);
  if (!real || !person || use == PedalUse::kNone) {
    return;
  }
  if (!d.pedal.input.empty()) {
    pedal_ = std::make_unique<device::Pedal>(d.pedal);
  } else if (use == PedalUse::kOnly) {
    throw InputError(
        fmt::format("{}: an answer is given by the pedal alone, but no table [pedal] says which "
                    "input device that is; add [pedal] to the definition or its lab file, or give "
                    "the choice keys, buttons or a place as well",
                    d.file_name));
  } else {
    notice_ =
        "the definition has a use for an analog pedal, but no table [pedal] says which input "
        "device that is, so that only keys and buttons count";
  }
}

std::vector<InputNews> SessionPedal::take_news() {
  return pedal_ == nullptr ? std::vector<InputNews>{}
                           : losses_.take(pedal_->input(), pedal_->take_changes());
}

std::string SessionPedal::losses() const {
  return pedal_ == nullptr ? "" : losses_.sentence(pedal_->input());
}

std::vector<InputNews> InputLosses::take(const std::string& input,
                                         const std::vector<device::InputChange>& changes) {
  std::vector<InputNews> all;
  for (const device::InputChange& change : changes) {
    if (change.back) {
      all.push_back({what_ + "_back", input, ""});
      continue;
    }
    ++losses_;
    const std::string notice = fmt::format(
        "the {0} {1} is lost ({2}): it {3} until it is connected again; events {4}_lost "
        "and {4}_back say when",
        name_, input, change.why, meanwhile_, what_);
    all.push_back(
        {what_ + "_lost", fmt::format("{}: {}", input, change.why), losses_ > 1 ? "" : notice});
  }
  return all;
}

std::string InputLosses::sentence(const std::string& input) const {
  return losses_ < 2
             ? ""
             : fmt::format("the {0} {1} was lost {2} times; events {3}_lost and {3}_back say when",
                           name_, input, losses_, what_);
}

}  // namespace haptrial::experiments
