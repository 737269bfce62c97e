#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/record/table/schema.h"

namespace haptrial::record {

/// One value as a column of the file has it.
using Cell = std::variant<std::int64_t, std::uint64_t, float, double, std::string>;

/// The values of a packed row, in the order of the columns: for who knows no C++ type of it.
std::vector<Cell> cells_of(const TableSchema& schema, std::span<const std::uint8_t> packed);

}  // namespace haptrial::record
