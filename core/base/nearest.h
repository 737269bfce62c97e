#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace haptrial {

/// The fewest letters to insert, leave out, replace or swap with their neighbour that turn `a` into
/// `b`; capital and small letters of ASCII are the same.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The one of `known` that a typo may have turned into `word`: less than a third of its letters
/// differ. The first of equally near ones; nothing if none is near.
std::optional<std::string> nearest(std::string_view word, const std::vector<std::string>& known);

/// "; did you mean NEAREST?", or nothing if none of `known` is near.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& known);

/// "WHAT is FOUND; did you mean NEAREST? allowed: ALLOWED, ALLOWED", for a value that is none of
/// those allowed. @param found  as it shall be shown: "'crve'"; quotes do not count as letters
std::string not_allowed(std::string_view what, std::string_view found,
                        const std::vector<std::string>& allowed);

}  // namespace haptrial
