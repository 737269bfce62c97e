#pragma once

#include "core/bone/data/shapes.h"

namespace haptrial::bone {

/// Places of a mean right ear that several parts of its shape follow from [mm].
inline const Point kVestibule{31.5, 24.4, 26.2};
inline const Point kCochlea{35.2, 20.2, 25.2};
inline const Point kDrum{24.6, 20.4, 20.9};  // middle of the ear drum
inline const Point kAntrum{22.6, 28.6, 27.2};
inline const Point kMeatus{3.5, 27.3, 15.2};      // beyond where the ear canal opens
inline const Point kBareNerve{28.0, 22.9, 26.3};  // where the facial nerve may lack its canal
inline constexpr double kBony = 6.2;              // x where the bony canal begins

}  // namespace haptrial::bone
