#pragma once

#include <cstddef>
#include <cstdint>

#include "core/scene/shape.h"
#include "protocols/psychophysics/presentation/trial_pass.h"

namespace haptrial::protocols {

class Names;
struct NamedStage;
struct Presented;

/// Content of a stage. @param seed  of its dots
StageSight sight_of(const NamedStage& stage, const Presented& presented, const Names& names,
                    std::uint64_t seed);

/// Mark of a place to touch, which a hand aims at: inside of it.
Mark mark_to_touch(const scene::Shape& shape, std::size_t device);

}  // namespace haptrial::protocols
