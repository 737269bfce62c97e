#pragma once

namespace haptrial::protocols {

struct BoneDefinition;

/// The radius of the smallest burr of a definition; 1 m without any. [m]
double smallest_burr(const BoneDefinition& definition);

}  // namespace haptrial::protocols
