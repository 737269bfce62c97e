#pragma once

#include <memory>
#include <vector>

#include "core/bone/simulator/companions.h"
#include "core/bone/simulator/simulator.h"
#include "core/bone/surface/surface_depths.h"
#include "core/render/gl/image.h"

namespace haptrial::protocols {

/// One bone and all that works on it or shows it. Shared by the session's thread and the screen's.
struct BoneStage {
  std::shared_ptr<const bone::BoneModel> model;
  Camera start_view;
  std::unique_ptr<bone::Simulator> simulator;
  std::unique_ptr<bone::Companions> companions;              // end before the simulator
  std::shared_ptr<const bone::StructureDepths> depths;       // null where nothing is drawn
  std::shared_ptr<const std::vector<render::Image>> stills;  // to be called up; may be null
};

}  // namespace haptrial::protocols
