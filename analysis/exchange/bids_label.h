#pragma once

#include <string>
#include <string_view>

namespace haptrial::exchange {

/// The letters and digits of a name, which is all that a label of the data set may have.
std::string bids_label(std::string_view text);

}  // namespace haptrial::exchange
