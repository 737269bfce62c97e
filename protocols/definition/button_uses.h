#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace haptrial {
class Table;
}

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

// Codes of the window's keys, as render::KeyPress has them.
inline constexpr int kSpaceKey = ' ';
inline constexpr int kEnterKey = 257;
inline constexpr int kBackspaceKey = 259;

/// The code of a key of the window by its name in a definition: "space", "enter", "left", "right",
/// "up", "down", "A" to "Z", "0" to "9"; nothing for another name.
std::optional<int> key_code(const std::string& name);

/// The names, for sentences.
inline constexpr const char* kKeyNames = "space, enter, A to Z, 0 to 9, left, right, up, down";

/// Codes of a list of keys by their names. A name that is not known is a problem, which is noted.
std::vector<int> read_window_keys(Table& table, const std::string& key);

}  // namespace haptrial::protocols
