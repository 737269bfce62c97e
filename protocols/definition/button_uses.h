#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace haptrial::protocols {

struct Definition;

/// The button of a device that stops the session, as the definition sets it up.
struct StopButton {
  std::string key;   // "haply.stop_button"
  int button{-1};    // -1: none
  bool given{true};  // in the definition or lab file; else it is the default
};

/// @param device  as --device takes it
/// @returns nothing if this device has no such key
std::optional<StopButton> stop_button_of(const Definition& definition, const std::string& device);

/// Sentences on buttons that two keys use at the same time, an emergency stop among them.
/// @param devices  of a session, in their order; a session with more has more like the last. Empty:
///                 each one that the definition sets up
std::vector<std::string> button_warnings(const Definition& definition,
                                         std::span<const std::string> devices = {});

}  // namespace haptrial::protocols
