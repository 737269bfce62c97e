#pragma once

#include "angle.h"
#include "circle.h"
#include "ring.h"
#include "robbins_monro.h"
#include "saw.h"
#include "valley.h"
#include "way_of_hand.h"

namespace own {

/// Adds every kind of this folder, once.
inline void add_all() {
  add_angle();
  add_circle();
  add_ring();
  add_saw();
  add_valley();
  add_way_of_hand();
  robbins_monro::add();
}

}  // namespace own
