#pragma once

#include <string>

namespace haptrial {

/// A list whose numbers have four digits, for people: "3.1415926536, left" becomes "3.142, left".
std::string short_numbers(const std::string& list);

}  // namespace haptrial
