#pragma once

#include <string>
#include <string_view>

namespace haptrial::analysis {

/// Bytes as text for data: addresses and for scripts (RFC 4648, with padding).
std::string base64(std::string_view bytes);

}  // namespace haptrial::analysis
