#pragma once

#include <string>
#include <vector>

namespace haptrial {

/// Names that differ only in what is easily typed by mistake: blanks, hyphens, underscores and the
/// capitals of ASCII. @returns the groups of two or more, each in the order given
std::vector<std::vector<std::string>> alike_names(const std::vector<std::string>& names);

/// "WARNING: the names of conditions differ only in blanks, hyphens or capitals and are taken for
/// different conditions: "a" (3 trials), "A" (1 trial)."
/// @param what   "conditions", "participants"
/// @param shown  the names, as they are to be shown
std::string alike_names_warning(const std::string& what, const std::vector<std::string>& shown);

}  // namespace haptrial
