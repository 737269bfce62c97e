#pragma once

#include <string_view>

namespace haptrial::protocols {

/// What a definition of trials need not state: tables of devices, hand, envelope, screen and texts.
std::string_view trials_defaults();

}  // namespace haptrial::protocols
