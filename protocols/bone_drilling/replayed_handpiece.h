#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "core/bone/record/drilling_tables.h"
#include "core/bone/record/tool_rows.h"
#include "core/bone/simulator/bone_touch.h"
#include "core/bone/simulator/simulator.h"
#include "core/record/read/session_reader.h"
#include "protocols/bone_drilling/drilling_pass.h"

namespace haptrial::protocols {

/// Reading of the device on a tick, as it is recorded.
device::DeviceReading reading_of(const record::Sample& sample, const record::ToolRow& tool);

/// Empty where a part of a tool was pushed as in the record.
/// @param recorded, force  in W [N]
std::string difference(std::uint64_t sequence, const char* part, const Eigen::Vector3d& recorded,
                       const Eigen::Vector3d& force);

/// Empty where shafts, wear and reverse are those of the record.
/// @param shaft  force of bone on the burr's shaft, in W [N]
std::string difference(const record::HandpieceRow& recorded, const bone::Simulator& simulator,
                       const Eigen::Vector3d& shaft);

/// Force on the hand of a led session from a handpiece that another session works with, simulated
/// again from its own readings and compared with the session's /handpiece. Ticks on which the hand
/// waited for the bone, which have nothing in their rows, are left out.
class ReplayedHandpiece {
 public:
  /// Everything given outlives it. @param simulator  as it is before the pass
  ReplayedHandpiece(const record::SessionReader& reader, const DrillingInput& input,
                    const bone::Simulator& simulator);

  /// Checks a tick; call after its steps, tick by tick. @returns the first difference; empty
  /// without any
  std::string check(std::uint64_t sequence);

 private:
  void read(std::uint64_t at);

  const record::SessionReader& reader_;
  const DrillingInput& input_;
  const bone::Simulator& simulator_;
  bone::BoneTouch touch_;
  std::vector<record::Sample> samples_;
  std::vector<record::ToolRow> tool_;
  std::vector<record::HandpieceRow> held_;
};

}  // namespace haptrial::protocols
