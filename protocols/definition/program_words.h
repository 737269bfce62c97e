#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace haptrial::protocols {

/// The words of the program itself that participants read, in another language, by the English
/// ones; empty for a language that the program does not speak.
std::map<std::string, std::string, std::less<>> program_words(std::string_view language);

/// The languages beside English: "de".
const std::vector<std::string>& program_languages();

}  // namespace haptrial::protocols
