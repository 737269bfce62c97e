#pragma once

#include <string>
#include <vector>

namespace haptrial {

/// Names that differ only in what is easily typed by mistake: blanks, hyphens, underscores, the
/// capitals of ASCII and zeros before whole numbers or after decimals. @returns the groups of two
/// or more, each in the order given
std::vector<std::vector<std::string>> alike_names(const std::vector<std::string>& names);

/// "WARNING: the names of conditions differ only in blanks, hyphens, capitals or zeros that change
/// no number and are taken for different conditions: "a" (3 trials), "A" (1 trial)."
/// @param what   "conditions", "participants"
/// @param shown  the names, as they are to be shown
std::string alike_names_warning(const std::string& what, const std::vector<std::string>& shown);

/// A warning for each group of alike names, in quotes. @param names  different ones
std::vector<std::string> alike_names_warnings(const std::string& what,
                                              const std::vector<std::string>& names);

}  // namespace haptrial
