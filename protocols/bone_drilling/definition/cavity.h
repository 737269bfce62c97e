#pragma once

#include "core/subject/drilling/cavity_chart.h"

namespace haptrial {
class Table;
}

namespace haptrial::protocols {

/// Reads a [cavity] table; every key is optional but `structures` goes with `margins`.
subject::CavityParameters read_cavity_parameters(Table& table);

}  // namespace haptrial::protocols
