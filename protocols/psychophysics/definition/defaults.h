#pragma once

#include <string_view>

namespace haptrial::protocols {

/// Tables that a definition of trials need not state: devices, hand, envelope, screen and texts.
std::string_view trials_defaults();

}  // namespace haptrial::protocols
