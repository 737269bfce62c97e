#pragma once

#include <cstddef>
#include <string_view>

namespace haptrial::record {

/// @throws std::invalid_argument for a text above `bytes` or with a NUL byte.
void check_text(std::string_view text, std::size_t bytes, const char* what);

}  // namespace haptrial::record
