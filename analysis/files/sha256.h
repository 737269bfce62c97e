#pragma once

#include <string>
#include <string_view>

namespace haptrial::analysis {

/// SHA-256 of some bytes in 64 hexadecimal digits, as sha256sum prints it.
std::string sha256(std::string_view bytes);

}  // namespace haptrial::analysis
