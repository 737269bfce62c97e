#pragma once

#include "core/subject/drilling/cavity_chart.h"

namespace haptrial {
template <class T>
class Schema;
}

namespace haptrial::protocols {

/// The keys of [cavity]; every key is optional but `structures` goes with `margins`.
const Schema<subject::CavityParameters>& cavity_schema();

}  // namespace haptrial::protocols
