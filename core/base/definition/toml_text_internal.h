#pragma once

#include <string_view>

#include <toml++/toml.h>

namespace haptrial {

/// The tree of a definition's text. Nothing else calls the parser
/// (TomlTextTest.NothingElseCallsTheParser): text that would overflow its stack or reach its
/// undefined behaviour is refused before it is read.
/// @throws InputError if the text is not TOML, with line and column, both from 1.
toml::table parse_toml(std::string_view text, std::string_view file_name);

}  // namespace haptrial
