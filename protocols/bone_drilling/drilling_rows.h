#pragma once

#include <cstdint>

#include "core/bone/hint/hints_beside.h"
#include "core/bone/nerve/nerve_beside.h"
#include "core/bone/nerve/nerve_exposures.h"
#include "core/bone/record/bone_rows.h"
#include "core/bone/record/drilling_tables.h"
#include "core/bone/record/tool_rows.h"
#include "core/bone/region/forbidden_region.h"
#include "core/bone/simulator/simulator.h"
#include "core/realtime/block_log.h"
#include "protocols/bone_drilling/live_tuning.h"
#include "protocols/interface/pass.h"

namespace haptrial::protocols {

/// Logs of the bone's changes, filled by the servo thread and emptied by the session's thread. A
/// cut empties CutPlaneTool::kMostEmptied voxels a tick at most: there is room for 1,024 such
/// ticks.
class DrillingLogs final : public TickLog {
 public:
  realtime::BlockLog<record::ToolRow> tool;
  realtime::BlockLog<record::RemovalRow> removals{1024, 256};
  realtime::BlockLog<record::CameraRow> camera{256, 64};
  realtime::BlockLog<record::SplitRow> splits{1024, 16};
  realtime::BlockLog<record::TearRow> tears{64, 16};
  realtime::BlockLog<record::LedRow> led{1024, 16};
  realtime::BlockLog<record::SecondHandRow> second;
  realtime::BlockLog<record::OpeningRow> openings{64, 16};
  realtime::BlockLog<record::HandpieceRow> handpiece;
  realtime::BlockLog<record::ToolContactRow> tool_contact;
  realtime::BlockLog<record::PieceRow> pieces{256, 64};
  realtime::BlockLog<record::ScrewRow> screws{64, 16};
  realtime::BlockLog<record::CrossingRow> crossings{256, 16};
  realtime::BlockLog<TakenTuning> tunings{64, 16};

  /// A row of /second_hand for every tick from now on, also between passes. Before the first tick.
  void watch_second() noexcept { two_hands_ = true; }
  /// Sets the present tick's row of the tube; taken by record(). Servo thread.
  void set_second(const record::SecondHandRow& row) noexcept { second_row_ = row; }

  /// A row of /handpiece for every tick from now on, likewise.
  void watch_handpiece() noexcept { watches_handpiece_ = true; }
  void set_handpiece(const record::HandpieceRow& row) noexcept { handpiece_row_ = row; }

  /// A row of /tool_contact for every tick from now on, likewise.
  void watch_tool_contact() noexcept { watches_tool_contact_ = true; }
  /// @param pushed  force on the first hand's tool, in W [N]
  void set_tool_contact(const Eigen::Vector3d& pushed) noexcept { tool_contact_.force = pushed; }

  /// Rows of pieces and screws from now on. Before the first tick.
  void watch_pieces() noexcept { watches_pieces_ = true; }
  bool watches_pieces() const noexcept { return watches_pieces_; }

  /// Sets the present tick's row of the tool in hand; taken by record(). Servo thread.
  void set_tool(const record::ToolRow& row) noexcept { row_ = row; }
  const record::ToolRow& tool_now() const noexcept { return row_; }
  /// Sets the present tick's effects on nerves; likewise.
  void set_nerves(const nerve::NerveTick& tick) noexcept { nerves_ = tick; }
  /// Gets every tick from the next one on, also between passes; null: nobody watches nerves.
  void watch_nerves(nerve::NerveBeside* beside) noexcept { beside_ = beside; }
  bool nerve_tone() const noexcept { return beside_ != nullptr && beside_->tone(); }
  /// A row of /tool for every tick, also between passes.
  void record(std::uint64_t sequence, const Readings& readings,
              device::Fault fault) noexcept override;

 private:
  record::ToolRow row_;
  record::SecondHandRow second_row_;
  bool two_hands_{false};
  record::HandpieceRow handpiece_row_;
  bool watches_handpiece_{false};
  record::ToolContactRow tool_contact_;
  bool watches_tool_contact_{false};
  bool watches_pieces_{false};
  nerve::NerveTick nerves_;
  nerve::NerveBeside* beside_{nullptr};
};

/// The pose of a piece after the simulator's last tick. Servo thread.
/// @param voxels  of a piece that was just born; else 0
record::PieceRow piece_row(const bone::Simulator& simulator, std::uint64_t sequence, int piece,
                           std::int64_t voxels) noexcept;

/// Log entries of a pass's ticks. Servo thread.
class DrillingRows {
 public:
  /// @param simulator, logs  outlive the rows
  DrillingRows(const bone::Simulator& simulator, DrillingLogs& logs, double rate) noexcept
      : simulator_(simulator), logs_(logs), rate_(rate) {}

  /// Logs the changes of the bone by the simulator's last tick. @param speed  of the tool [m/s]
  void log(std::uint64_t sequence, double speed) noexcept;
  /// A moving view is logged a hundred times a second at most, and where it comes to rest. Each
  /// tick of the pass.
  void log_camera(std::uint64_t sequence, bool changed) noexcept;
  /// Pieces that were born, or that a hand moves, and screws. Each tick of the pass.
  void log_pieces(std::uint64_t sequence) noexcept;
  /// The tool in hand after it. @param removed  in this tick [voxels]
  void log_tool(double removed, const Eigen::Vector3d& contact) noexcept;
  /// Shafts, wear and reverse after it. @param shaft  force on the burr's shaft [N]
  void log_handpiece(const Eigen::Vector3d& shaft) noexcept;
  /// The tube in the other hand after it.
  void log_second(const bone::TubeInput& tube) noexcept;

 private:
  const bone::Simulator& simulator_;
  DrillingLogs& logs_;
  double rate_;
  bool first_{true};
  bool camera_due_{true};           // a change is not logged yet
  std::uint64_t camera_logged_{0};  // sequence number of the last row
  int carried_for_{0};              // ticks
};

/// Tells hints the changes by the simulator's last tick.
void tell_hints(hint::HintsBeside& hints, std::uint64_t sequence, const bone::Simulator& simulator,
                const bone::SimulatorInput& input) noexcept;

/// The tool after a tick of the simulator, as nerves have it. They lie in the bone that was there
/// at the beginning, and go with it.
nerve::ToolAtNerves tool_at_nerves(const bone::Simulator& simulator,
                                   const bone::SimulatorInput& input) noexcept;

}  // namespace haptrial::protocols
