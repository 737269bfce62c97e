#pragma once

#include <memory>

#include "core/bone/hint/chime.h"
#include "core/bone/region/forbidden_region.h"
#include "core/bone/simulator/simulator.h"
#include "protocols/bone_drilling/drilling_rows.h"

namespace haptrial::protocols {

/// The forbidden regions of one bone while it is drilled: force, chime and the record of crossings.
class RegionGuard {
 public:
  /// @param chime  rings where a burr enters; null: none
  RegionGuard(const bone::RegionSetup& setup, std::shared_ptr<const bone::RegionMap> map,
              std::shared_ptr<hint::Chime> chime);

  /// A pass begins. @param given  whether the participant feels or hears the regions in it
  void begin_pass(bool given) noexcept;
  /// Servo thread: no allocation. @returns the force on the tool, in W [N]
  Eigen::Vector3d tick(std::uint64_t sequence, const bone::Simulator& simulator,
                       const bone::SimulatorInput& input, DrillingLogs& logs) noexcept;
  /// Ends the crossings that are on; no drilling ticks.
  void end_pass(DrillingLogs& logs) noexcept { crossings_.end(logs.crossings); }

 private:
  bone::ForbiddenRegion region_;
  bone::CrossingWatch crossings_;
  std::shared_ptr<hint::Chime> chime_;
  bool given_{true};
  int tool_{-1};  // in hand on the last tick; -1: the hand steered or carried
};

}  // namespace haptrial::protocols
