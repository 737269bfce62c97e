#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/bone/simulator/drilling_view.h"
#include "core/bone/surface/surface.h"
#include "core/render/bone/bone_scene.h"
#include "core/render/bone/bone_stills.h"
#include "core/render/gl/image.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/bone_drilling/display/bone_stage.h"
#include "protocols/bone_drilling/display/ct_slices.h"
#include "protocols/bone_drilling/display/picture_labels.h"
#include "protocols/bone_drilling/display/plan_section.h"
#include "protocols/interface/drawing.h"

namespace haptrial::protocols {

/// How deep structures lie, for what shows through. Takes a second for a large bone.
std::shared_ptr<const bone::StructureDepths> depths_of(const bone::BoneModel& model);

/// Draws a stage as a participant sees it. One thread with its OpenGL context current.
class BoneDisplay {
 public:
  /// @param surface  built_surface() of the stage, for this display alone; null: the first draw()
  /// builds it
  /// @throws RunError where OpenGL does not give what is needed.
  BoneDisplay(const render::Gl& gl, const BoneDefinition& definition,
              std::shared_ptr<const BoneStage> stage, int width, int height,
              const render::BoneStyle& style = {},
              std::shared_ptr<bone::Surface> surface = nullptr);

  /// @param seen  of this stage; whatever moves beside it is taken as published
  void draw(const bone::DrillingView& seen);
  void set_quality(render::Quality quality) noexcept { scene_.set_quality(quality); }
  /// Sets the pictures that can be called up from now on; at first those of the stage. Null:
  /// nothing.
  void set_stills(std::shared_ptr<const std::vector<render::Image>> stills);
  /// Shows the section by the plan of the cavity, or hides it; without [cavity] there is none.
  void toggle_plan();
  /// Shows slices through the tip as of a scan, or hides them.
  void toggle_slices() { slices_shown_ = !slices_shown_; }
  /// The camera of the last picture, or of one of its two.
  const Camera& camera() const { return frame_.camera; }
  int width() const { return frame_.stereo ? width_ / 2 : width_; }
  int height() const { return height_; }

 private:
  std::shared_ptr<const geometry::Mesh> mesh_of(int tool) const;
  std::vector<render::Capsule> shadow_of(int tool) const;
  void draw_screws(const std::vector<Eigen::Isometry3d>& plates);
  void label(const bone::DrillingView& seen);
  void show_injury(const bone::DrillingView& seen);
  std::vector<std::string> hints_in(const bone::DrillingView& seen) const;
  void draw_still(std::int32_t asked);
  void draw_plan(const bone::DrillingView& seen);
  void draw_slices(const bone::DrillingView& seen);

  render::Gl gl_;

  std::shared_ptr<const BoneStage> stage_;
  std::shared_ptr<bone::Surface> surface_;  // until the first draw()
  int width_;
  int height_;
  render::BoneScene scene_;
  render::BoneFrame frame_;
  PictureLabels labels_;
  std::optional<hint::HintSetup> hints_;
  std::vector<std::string> vital_;  // names, as HintsNow::structure counts them
  std::vector<std::shared_ptr<const geometry::Mesh>> meshes_;  // by tool
  std::vector<std::shared_ptr<const geometry::Mesh>> screws_;  // by tool; null where it drives none
  std::shared_ptr<const geometry::Mesh> tube_;  // in the other hand; null: there is none
  std::uint64_t dust_version_{~std::uint64_t{0}};
  std::uint64_t blood_version_{~std::uint64_t{0}};
  std::unique_ptr<render::BoneStills> stills_;  // null where there are none
  const BoneDefinition& definition_;
  std::unique_ptr<PlanSection> plan_;  // null until it is asked for
  std::unique_ptr<render::BoneStills> plan_picture_;
  bool plan_shown_{false};
  int plan_age_{0};  // of its picture [frames]
  CtSlices slices_;
  std::unique_ptr<render::BoneStills> slices_picture_;  // null until they are shown
  bool slices_shown_;
};

/// The surface of a stage's bone as it is now, on all processors: what a first picture waits for.
/// @param report  as bone::Surface::build() has it
std::shared_ptr<bone::Surface> built_surface(const BoneStage& stage,
                                             const geometry::WorkReport& report = {});

/// The same for a screen, on which pointer and keys may move a hand in space; keys that the
/// definition uses otherwise do not. The definition outlives the screen. @param surface  as
/// BoneDisplay has it
MakeDrawing bone_drawing(const BoneDefinition& definition, std::shared_ptr<const BoneStage> stage,
                         std::shared_ptr<bone::Surface> surface = nullptr);

}  // namespace haptrial::protocols
