#include "protocols/definition/button_uses.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>

#include "core/base/definition/table.h"
#include "core/device/vendor_devices.h"
#include "protocols/definition/definition.h"

namespace haptrial::protocols {
namespace {

/// A device with a key `stop_button`; those of makers have the names that vendor_devices() has.
struct Stoppable {
  const char* device;
  const char* table;
  int (*button)(const Definition& d);
};

constexpr std::array kStoppable{
    Stoppable{"force-dimension", "force_dimension",
              [](const Definition& d) { return d.vendor.force_dimension.stop_button; }},
    Stoppable{"open-haptics", "open_haptics",
              [](const Definition& d) { return d.vendor.open_haptics.stop_button; }},
    Stoppable{"haply", "haply", [](const Definition& d) { return d.vendor.haply.stop_button; }},
    Stoppable{"paddle", "paddle", [](const Definition& d) { return d.vendor.paddle.stop_button; }},
    Stoppable{"mouse", "mouse", [](const Definition& d) { return d.mouse.stop_button; }},
    Stoppable{"gamepad", "gamepad", [](const Definition& d) { return d.gamepad.stop_button; }},
};

bool has_table(const Definition& d, const char* table) {
  return d.document != nullptr && d.root().has(table);
}

/// With those that every protocol has: a recorded run is paused in stages, and not while a question
/// is asked. Without the key, force training means all buttons, which is no second function.
std::vector<ButtonUse> uses_of(const Definition& d) {
  std::vector<ButtonUse> uses = d.button_uses();
  if (has_table(d, "tutoring") && d.root().table("tutoring").has("pause_buttons")) {
    uses.push_back({"tutoring.pause_buttons", d.tutoring.pause_buttons, "stages"});
  }
  std::erase_if(uses, [](const ButtonUse& use) { return use.buttons == 0; });
  return uses;
}

bool at_once(const ButtonUse& a, const ButtonUse& b) {
  const bool one_device = !a.device || !b.device || *a.device == *b.device;
  return one_device && (a.heard_in.starts_with(b.heard_in) || b.heard_in.starts_with(a.heard_in));
}

void warn_of_doubles(const std::vector<ButtonUse>& uses, std::vector<std::string>& warnings) {
  for (std::size_t i = 0; i < uses.size(); ++i) {
    for (std::size_t before = 0; before < i; ++before) {
      const std::uint32_t both = uses[before].buttons & uses[i].buttons;
      if (both != 0 && at_once(uses[before], uses[i])) {
        warnings.push_back(
            fmt::format("{} and {} both take button {}, so that one press does both; give one of "
                        "them another button",
                        uses[before].key, uses[i].key, std::countr_zero(both)));
      }
    }
  }
}

/// @param place  of the device in the session, from 0; nothing: any
void warn_of_stop(const StopButton& stop, std::optional<std::size_t> place,
                  const std::vector<ButtonUse>& uses, std::vector<std::string>& warnings) {
  for (const ButtonUse& use : uses) {
    const bool here = !place || !use.device || *use.device == *place;
    if (here && stop.button >= 0 && (use.buttons >> stop.button & 1U) != 0) {
      const std::string sentence = fmt::format(
          "{} is {}{}, and {} takes button {}, too, so that who presses it stops the "
          "session; give one of them another button",
          stop.key, stop.button, stop.given ? "" : " by default", use.key, stop.button);
      if (std::ranges::find(warnings, sentence) == warnings.end()) {
        warnings.push_back(sentence);
      }
    }
  }
}

}  // namespace

std::optional<StopButton> stop_button_of(const Definition& d, const std::string& device) {
  for (const Stoppable& each : kStoppable) {
    if (device == each.device) {
      return StopButton{std::string(each.table) + ".stop_button", each.button(d),
                        has_table(d, each.table)};
    }
  }
  return std::nullopt;
}

std::vector<std::string> button_warnings(const Definition& d,
                                         std::span<const std::string> devices) {
  const std::vector<ButtonUse> uses = uses_of(d);
  std::vector<std::string> warnings;
  for (std::size_t i = 0; !devices.empty() && i < std::max<std::size_t>(2, devices.size()); ++i) {
    if (const auto stop = stop_button_of(d, devices[std::min(i, devices.size() - 1)])) {
      warn_of_stop(*stop, i, uses, warnings);
    }
  }
  for (const Stoppable& each : kStoppable) {
    const auto stop = stop_button_of(d, each.device);
    if (devices.empty() && stop->given) {
      warn_of_stop(*stop, std::nullopt, uses, warnings);
    }
  }
  warn_of_doubles(uses, warnings);
  return warnings;
}

}  // namespace haptrial::protocols
