#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace haptrial {

/// A key that a definition states.
struct StatedKey {
  std::string key;      // path as in GivenKey
  std::string value;    // as the text has it; empty: a table, whose keys follow
  std::size_t line{0};  // of the key, from 1, likewise its column
  std::size_t column{0};
  bool table{false};
};

/// Every key of a definition and every table, in the order of the text; of an inline table its
/// keys, of an array its whole text. Left out is what no path can name: keys with a dot in their
/// name.
/// @throws InputError for a text that is not TOML
std::vector<StatedKey> stated_keys(std::string_view text, std::string_view file_name);

}  // namespace haptrial
