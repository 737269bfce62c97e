#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "core/bone/record/drilling_types.h"
#include "core/bone/record/tear_row.h"
#include "core/bone/simulator/companions.h"
#include "core/bone/simulator/drilling_view.h"
#include "core/bone/simulator/simulator.h"
#include "core/nerve/beside/nerve_beside.h"
#include "core/nerve/setup/nerve_exposures.h"
#include "core/realtime/block_log.h"
#include "core/sound/drill_sound.h"
#include "protocols/bone_drilling/definition/drilling_parameters.h"
#include "protocols/interface/pass.h"

namespace haptrial::protocols {

/// Where the servo thread leaves what happens to the bone; emptied by the session's thread. A cut
/// empties CutPlaneTool::kMostEmptied voxels a tick at most: there is room for 1,024 such ticks.
class DrillingLogs final : public TickLog {
 public:
  realtime::BlockLog<record::ToolRow> tool;
  realtime::BlockLog<record::RemovalRow> removals{1024, 256};
  realtime::BlockLog<record::CameraRow> camera{256, 64};
  realtime::BlockLog<record::SplitRow> splits{1024, 16};
  realtime::BlockLog<record::TearRow> tears{64, 16};

  /// What the present tick says of the tool in hand; taken by record(). Servo thread.
  void set_tool(const record::ToolRow& row) noexcept { row_ = row; }
  const record::ToolRow& tool_now() const noexcept { return row_; }
  /// What the present tick does to nerves; likewise.
  void set_nerves(const nerve::NerveTick& tick) noexcept { nerves_ = tick; }
  /// Gets every tick from the next one on, also between passes; null: nobody watches nerves.
  void watch_nerves(nerve::NerveBeside* beside) noexcept { beside_ = beside; }
  bool nerve_tone() const noexcept { return beside_ != nullptr && beside_->tone(); }
  /// A row of /tool for every tick, also between passes.
  void record(std::uint64_t sequence, const Readings& readings,
              device::Fault fault) noexcept override;

  std::uint64_t dropped() const noexcept {
    return tool.dropped() + removals.dropped() + camera.dropped() + splits.dropped() +
           tears.dropped();
  }

 private:
  record::ToolRow row_;
  nerve::NerveTick nerves_;
  nerve::NerveBeside* beside_{nullptr};
};

/// A reading on the grids of the session file: what is simulated from it, is simulated again from
/// the file. Servo thread.
device::DeviceReading as_recorded(const device::DeviceReading& reading) noexcept;

/// What a reading, as it is recorded, asks of the simulator.
class DrillingInput {
 public:
  /// @throws std::invalid_argument for a handle without length or a scale not above 0.
  explicit DrillingInput(const DrillingParameters& parameters);
  bone::SimulatorInput of(const device::DeviceReading& recorded, double dt) const noexcept;

 private:
  DrillingParameters parameters_;
  Eigen::Quaterniond grip_;  // from the tool frame T to the handle's
};

/// What a participant is to see of a simulator.
bone::DrillingView view_of(const bone::Simulator& simulator,
                           const bone::SimulatorInput& input) noexcept;

/// Work on a bone: drilling, suction, cutting, plating, looking around. Ends when the time is over
/// or the participant says so. Source: Morris 2006, §3.2 and §8.2.2.
class DrillingPass final : public Pass {
 public:
  /// Everything given outlives the pass.
  /// @param spent      ticks of the time limit that passes before this one have taken
  /// @param vibration  of the burr; null: it does not shake
  /// @param nerves     of the bone; null: nobody watches them
  DrillingPass(bone::Simulator& simulator, bone::Companions& companions,
               const DrillingParameters& parameters, DrillingLogs& logs, double rate,
               std::uint64_t spent = 0, sound::DrillVibration* vibration = nullptr,
               nerve::NerveExposures* nerves = nullptr);

  void begin(std::uint64_t sequence) noexcept override;
  PassOutput tick(const Readings& readings, double dt) noexcept override;
  PassState state() const noexcept override { return state_; }
  bool wants_attention() noexcept override;

  /// Of this pass and those before it. Not the servo thread while it ticks.
  std::uint64_t ticks() const noexcept { return ticks_; }

 private:
  nerve::ToolAtNerves tool_at_nerves(const bone::SimulatorInput& input) const noexcept;
  Eigen::Vector3d shaking(const bone::SimulatorInput& input) noexcept;
  void log(const bone::SimulatorOutput& out, double speed) noexcept;
  void log_camera(bool changed) noexcept;

  bone::Simulator& simulator_;
  bone::Companions& companions_;
  DrillingParameters parameters_;
  DrillingInput input_;
  DrillingLogs& logs_;
  double rate_;
  sound::DrillVibration* vibration_;
  nerve::NerveExposures* nerves_;
  std::uint64_t time_limit_;  // [ticks]
  std::uint64_t ticks_;
  std::uint64_t sequence_{0};
  bool first_{true};
  bool camera_due_{false};                   // a change is not logged yet
  std::uint64_t camera_logged_{0};           // sequence number of the last row
  std::array<std::uint64_t, 3> attended_{};  // rows of each log, when attention was asked for last
  PassState state_{PassState::kRunning};
};

}  // namespace haptrial::protocols
