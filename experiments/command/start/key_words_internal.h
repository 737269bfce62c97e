#pragma once

#include <string_view>

namespace haptrial::experiments {

/// What keys are, a line each: "PATH | DEFAULT | MEANING". A DEFAULT stands only where the reader
/// of the key does not say it. PATH may begin with "PROTOCOL:" where protocols differ.
std::string_view key_words();

}  // namespace haptrial::experiments
