#pragma once

#include <string>
#include <string_view>

namespace haptrial::experiments {

/// Headings and controls of a preview in another language; the English words if there are none.
/// @param language  "de"; "" and "en" are English
std::string in_language(std::string_view english, std::string_view language);

/// A page with its headings in another language, marked as such; all else stays.
std::string with_headings_in(std::string page, std::string_view language);

}  // namespace haptrial::experiments
