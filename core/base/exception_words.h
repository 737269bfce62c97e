#pragma once

#include <exception>
#include <string>

namespace haptrial {

/// The text a user reads of an exception: its own, or a sentence for those of the standard library,
/// whose words name functions ("std::bad_alloc").
std::string sentence_of(const std::exception& error);

/// Whether other input would mend it: an InputError, or a path that the system refuses.
bool is_bad_input(const std::exception& error);

}  // namespace haptrial
