#pragma once

#include <string>
#include <vector>

#include "core/base/definition/schema_forward.h"

namespace haptrial::psychometric {

struct TrackKeys;

/// A list of numbers, one number, or { from, to, count, [spacing] }. Problems are noted.
std::vector<double> read_grid(Table& table, const std::string& key);

/// The last of these. @param grid  the table itself
std::vector<double> read_spaced_grid(Table& grid);

/// Reads `levels`, a grid of what a track may present.
std::vector<double> read_levels(const TrackKeys& keys);

}  // namespace haptrial::psychometric
