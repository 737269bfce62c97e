#include "experiments/runner/session_pedal.h"

#include <fmt/format.h>

#include "core/base/error.h"

namespace haptrial::experiments {

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

}  // namespace haptrial::experiments
