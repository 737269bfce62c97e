#pragma once

#include <string>
#include <string_view>

namespace haptrial {

/// A text as a TOML file has it: in double quotes, with escapes. Any thread.
std::string toml_text(std::string_view text);

}  // namespace haptrial
