#pragma once

#include <string>

namespace haptrial::experiments {

/// Asks whoever sits at the terminal. @returns whether the line that was typed is y
/// @throws RunError on an interrupt, which does not wait for the line
bool confirms(const std::string& question);

}  // namespace haptrial::experiments
