#include "core/render/bone/bone_style.h"

namespace haptrial::render {

BoneStyle microscope_style() {
  BoneStyle style;
  style.ambient = 0.24;
  style.diffuse = 0.72;
  style.specular = 0.22;
  style.shininess = 70.0;
  style.vignette = 0.6;
  return style;
}

}  // namespace haptrial::render
