#pragma once

#include <string>
#include <vector>

namespace haptrial {
class Table;
}

namespace haptrial::protocols {

/// A list of numbers, one number, or { from, to, count, [spacing] }. Problems are noted.
std::vector<double> read_grid(Table& table, const std::string& key);

/// The last of these. @param grid  the table itself
std::vector<double> read_spaced_grid(Table& grid);

}  // namespace haptrial::protocols
