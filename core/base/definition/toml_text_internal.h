#pragma once

#include <string_view>

#include <toml++/toml.h>

namespace haptrial {

/// What a definition holds. The only way to the parser (TomlTextTest.NothingElseCallsTheParser):
/// what would overflow its stack or reach undefined behaviour of it is refused before it is read.
/// @throws InputError if the text is not TOML, with the line.
toml::table parse_toml(std::string_view text, std::string_view file_name);

}  // namespace haptrial
