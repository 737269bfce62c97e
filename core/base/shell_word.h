#pragma once

#include <string>

namespace haptrial {

/// A word of a command as a shell takes it: itself, or between single quotes if a shell would read
/// something into it.
std::string shell_word(const std::string& word);

}  // namespace haptrial
