#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/definition/schema_forward.h"

namespace haptrial::protocols {

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
