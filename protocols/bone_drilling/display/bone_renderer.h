#pragma once

#include <memory>

#include "core/bone/simulator/drilling_view.h"
#include "core/render/gl/image.h"
#include "core/render/gl/offscreen.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/bone_drilling/display/bone_display.h"
#include "protocols/bone_drilling/display/bone_stage.h"

namespace haptrial::protocols {

/// Draws a stage off screen; stills are made when the first is called up. The definition outlives
/// it.
class BoneRenderer {
 public:
  BoneRenderer(const BoneDefinition& definition, std::shared_ptr<const BoneStage> stage);
  render::Image draw(const bone::DrillingView& seen);

 private:
  const BoneDefinition& definition_;
  std::shared_ptr<const BoneStage> stage_;
  bool has_stills_{false};
  render::OffscreenContext context_;
  BoneDisplay display_;
};

}  // namespace haptrial::protocols
