#pragma once

#include <functional>

#include "core/bone/data/ear_anatomy.h"
#include "core/bone/model/bone_model.h"
#include "core/geometry/mesh/work.h"

namespace haptrial::bone {

/// The size of a bone that is made: millimetres of its shapes, and metres of the result.
struct MadeGrid {
  Point low;       // corner of the box [mm]
  Point high;      // the opposite one [mm]
  double scale;    // what is 1 mm in the shapes has this many [mm]
  double spacing;  // [m]
  int threads;     // 0: one per processor
  const char* name;
};

/// Asks a bone made from shapes for what every voxel holds; rows in parallel, the same bytes on
/// any number of threads. Densities are n/255.
BoneModel fill(const MadeGrid& made,
               const std::function<EarAnatomy::Material(const Point&)>& material,
               const geometry::WorkReport& report);

}  // namespace haptrial::bone
