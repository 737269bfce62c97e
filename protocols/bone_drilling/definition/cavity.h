#pragma once

#include "core/subject/drilling/cavity_chart.h"

namespace haptrial {
template <class T>
class Schema;
}

namespace haptrial::protocols {

struct BoneDefinition;

/// The radius of the smallest burr of a definition; 1 m without any. [m]
double smallest_burr(const BoneDefinition& definition);

/// The keys of [cavity]; every key is optional but `structures` goes with `margins`.
const Schema<subject::CavityParameters>& cavity_schema();

}  // namespace haptrial::protocols
