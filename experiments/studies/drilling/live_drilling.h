#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "analysis/bone_drilling/metrics/live.h"
#include "analysis/bone_drilling/metrics/procedure.h"
#include "core/bone/record/bone_rows.h"
#include "core/bone/record/drilling_tables.h"
#include "core/record/rows/live_figures.h"
#include "core/record/rows/session_types.h"

namespace haptrial::experiments {

/// A procedure of a running session, or of one that has ended.
struct DrilledProcedure {
  int trial{0};  // from 1; 0 of practice
  bool practice{false};
  analysis::drilling::LiveFigures figures;
};

/// Figures of a procedure for people: in rows, and in one line, "procedure 1: 1:05, drilling 0:40,
/// ...".
record::LiveState state_of(const DrilledProcedure& procedure);

/// Measures the drillings of a session while it runs. The session's thread gives it the rows that
/// go into the file and never waits; a thread of its own measures them, ten times a second.
///
/// What it says after the last row is what an analysis of the file says, to the bit.
class LiveDrilling {
 public:
  /// @param setup  of the session; its group is not needed
  /// @param rate   of ticks [Hz]
  LiveDrilling(analysis::drilling::ProcedureSetup setup, double rate);
  ~LiveDrilling();
  LiveDrilling(const LiveDrilling&) = delete;
  LiveDrilling& operator=(const LiveDrilling&) = delete;

  // The session's thread.

  /// A pass begins; one of the same trial and repetition goes on with its procedure, another has a
  /// bone of its own.
  /// @param earlier  what an earlier run of the session did to that bone; null: nothing
  void begin(const record::PassRow& pass, std::shared_ptr<const bone::BoneModel> bone,
             std::shared_ptr<const analysis::drilling::Procedure> earlier = nullptr);
  void add(std::span<const record::ToolRow> rows);
  void add(std::span<const record::RemovalRow> rows);
  void add(std::span<const record::CameraRow> rows);
  void add(std::span<const record::SplitRow> rows);
  void add(std::span<const record::PieceRow> rows);
  void add(std::span<const record::ScrewRow> rows);
  /// Ticks of which all other rows have been given.
  void add(std::span<const record::Sample> samples);
  /// Waits until everything that was given is measured. No more rows after that.
  void finish();

  // Any thread.

  /// The present procedure, or the last one, as far as it is measured; nothing before the first.
  std::optional<DrilledProcedure> now() const;
  /// All but practice, in order; of a trial that was begun anew the last one.
  std::vector<DrilledProcedure> procedures() const;
  /// Why it has ceased to measure, in a sentence; empty while it does.
  std::string trouble() const;

 private:
  struct Batch;
  struct Bone;
  void run(const std::stop_token& stop);
  void measure(Batch& batch);
  void show(const Bone& bone);

  const analysis::drilling::ProcedureSetup setup_;
  const double rate_;
  std::unique_ptr<Batch> given_;  // the session's thread: since the last samples

  mutable std::mutex mutex_;
  std::condition_variable_any ended_;
  std::vector<std::unique_ptr<Batch>> waiting_;
  std::vector<DrilledProcedure> procedures_;
  std::string trouble_;

  std::unique_ptr<Bone> bone_;  // the measuring thread
  std::jthread thread_;
};

}  // namespace haptrial::experiments
