#include "experiments/devices/session_pedal.h"

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

std::vector<SessionPedal::News> SessionPedal::take_news() {
  std::vector<News> all;
  if (pedal_ == nullptr) {
    return all;
  }
  for (const device::Pedal::Change& change : pedal_->take_changes()) {
    if (change.back) {
      all.push_back({"pedal_back", pedal_->input(), ""});
      continue;
    }
    const std::string what = fmt::format("the pedal {} is lost ({})", pedal_->input(), change.why);
    ++losses_;
    all.push_back({"pedal_lost", fmt::format("{}: {}", pedal_->input(), change.why),
                   losses_ > 1 ? ""
                               : what + ": it counts as up until it is connected again; events "
                                        "pedal_lost and pedal_back say when"});
  }
  return all;
}

std::string SessionPedal::losses() const {
  return losses_ < 2 ? ""
                     : fmt::format(
                           "the pedal {} was lost {} times; events pedal_lost and "
                           "pedal_back say when",
                           pedal_->input(), losses_);
}

}  // namespace haptrial::experiments
