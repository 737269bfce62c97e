#pragma once

#include <exception>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/bone/simulator/drilling_view.h"
#include "core/render/gl/image.h"
#include "core/render/gl/offscreen.h"
#include "core/stimulus/observer.h"
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

/// Pictures of a drilling at evenly spaced moments of its time limit, for a session on a simulated
/// clock: they are drawn at their moment, for the bone does not stay as it is.
class BonePictures final : public stimulus::Observer {
 public:
  /// @param wanted  pictures of each pass > 0
  BonePictures(const BoneDefinition& definition, int wanted);

  /// Watches a stage; call before a pass.
  void watch(std::shared_ptr<const BoneStage> stage);
  void observe(const stimulus::Shown& shown, const stimulus::Forces& forces,
               double dt) noexcept override;
  /// Writes the pictures of a pass that has ended: FOLDER/NAME-01.png and so on. @throws RunError
  /// where one cannot be drawn or written.
  void write(const std::filesystem::path& folder, const std::string& name);

 private:
  const BoneDefinition& definition_;
  std::size_t wanted_;
  std::shared_ptr<const BoneStage> stage_;
  std::unique_ptr<BoneRenderer> renderer_;
  std::vector<render::Image> images_;
  std::exception_ptr failure_;
};

}  // namespace haptrial::protocols
