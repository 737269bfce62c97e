#include "protocols/bone_drilling/display/placed_bone.h"

#include "protocols/bone_drilling/definition/smallest_burr.h"

namespace haptrial::protocols {

PlacedBone placed_bone(const BoneDefinition& d, std::size_t bone) {
  PlacedBone placed{d.bones[bone],   d.placement,      d.mirror, d.simulator.camera.start,
                    d.display.width, d.display.height, {},       {},
                    smallest_burr(d)};
  if (d.cavity) {
    placed.beside = d.cavity->beside;
  }
  if (!d.charts.empty()) {
    placed.cavity = d.charts[bone];
  }
  return placed;
}

}  // namespace haptrial::protocols
