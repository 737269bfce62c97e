#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/bone/simulator/drilling_view.h"
#include "core/render/bone/bone_scene.h"
#include "core/render/bone/bone_stills.h"
#include "core/render/gl/image.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/bone_drilling/display/bone_stage.h"
#include "protocols/interface/drawing.h"

namespace haptrial::protocols {

/// How deep structures lie, for what shows through. Takes a second for a large bone.
std::shared_ptr<const bone::StructureDepths> depths_of(const bone::BoneModel& model);

/// Draws a stage as a participant sees it. One thread with its OpenGL context current.
class BoneDisplay {
 public:
  /// @throws RunError where OpenGL does not give what is needed.
  BoneDisplay(const render::Gl& gl, const BoneDefinition& definition,
              std::shared_ptr<const BoneStage> stage, int width, int height);

  /// @param seen  of this stage; whatever moves beside it is taken as published
  void draw(const bone::DrillingView& seen);
  /// What can be called up from now on; at first those of the stage. Null: nothing.
  void set_stills(std::shared_ptr<const std::vector<render::Image>> stills);

 private:
  std::shared_ptr<const geometry::Mesh> mesh_of(int tool) const;
  void draw_still(std::int32_t asked);

  render::Gl gl_;

  std::shared_ptr<const BoneStage> stage_;
  int width_;
  int height_;
  render::BoneScene scene_;
  render::BoneFrame frame_;
  std::vector<std::shared_ptr<const geometry::Mesh>> meshes_;  // by tool
  std::uint64_t dust_version_{~std::uint64_t{0}};
  std::unique_ptr<render::BoneStills> stills_;  // null where there are none
};

/// The same for a screen. The definition outlives the screen.
MakeDrawing bone_drawing(const BoneDefinition& definition, std::shared_ptr<const BoneStage> stage);

}  // namespace haptrial::protocols
