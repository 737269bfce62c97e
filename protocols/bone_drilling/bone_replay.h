#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/bone/record/bone_rows.h"
#include "core/bone/record/drilling_tables.h"
#include "core/bone/record/tool_rows.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/device_rows.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/bone_drilling/display/bone_stage.h"

namespace haptrial::protocols {

/// Result of simulating a procedure again.
struct ReplayVerdict {
  int trial{0};
  int passes{0};
  std::uint64_t ticks{0};
  std::uint64_t emptied{0};   // voxels
  std::uint64_t tears{0};     // of soft tissue
  std::uint64_t checksum{0};  // of the last pass
  bool whole{true};           // each pass has a checksum: the session came to the end of each
  std::string difference;  // the first one from the record, a sentence; empty where there is none
};

/// Simulates the drillings of a session file again, from its bones, its ticks and its splits, and
/// holds what comes out against its removals and checksums. Nothing else is needed.
class BoneReplay {
 public:
  /// @throws InputError where the file holds no drillings, or its definition is not one of this
  /// version.
  explicit BoneReplay(const std::filesystem::path& session);

  const BoneDefinition& definition() const { return definition_; }
  double rate() const { return reader_.info().rate; }
  /// Trials that have a pass, ascending.
  std::vector<int> trials() const;
  /// Ticks of a trial that were simulated.
  std::uint64_t ticks(int trial) const;

  /// `repetition` of a trial's last bone. @throws InputError for a trial that is not there.
  std::int32_t last_bone(int trial) const;

  /// Called about every 500 ticks; what it throws ends the replay. @param tick  of the trial, from
  /// 0
  using Pulse = std::function<void(std::uint64_t tick)>;
  /// Callback with the view of a tick. @param tick  of the trial, from 0 @param sequence  as in
  /// /samples
  using Watch =
      std::function<void(std::uint64_t tick, std::uint64_t sequence, const bone::DrillingView& seen,
                         const std::shared_ptr<const BoneStage>& stage)>;
  /// @param watch  may be empty: dust is then left out, which nothing else depends on
  /// @throws InputError for a trial that is not there.
  ReplayVerdict run(int trial, const Watch& watch = {}) const;

  /// One bone of a trial as it stood after all that is recorded of it.
  /// @param bone     `repetition` of its passes
  /// @param verdict  receives how that went; at its first difference the replay ends
  /// @returns its simulator, without companions and depths; null where no pass is on that bone
  std::shared_ptr<BoneStage> restore(int trial, std::int32_t bone, ReplayVerdict& verdict,
                                     const Pulse& pulse = {}) const {
    return restore_until(kNever, trial, bone, verdict, pulse);
  }
  /// The same after a number of simulated ticks of the trial, or at its end if it has fewer.
  std::shared_ptr<BoneStage> restore_until(std::uint64_t ticks, int trial, std::int32_t bone,
                                           ReplayVerdict& verdict, const Pulse& pulse = {}) const;
  const record::SessionReader& reader() const { return reader_; }

 private:
  static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

  [[noreturn]] void refuse_trial(int trial) const;
  /// Observers of a replay.
  struct Onlookers {
    const Watch& watch;
    const Pulse& pulse;
    std::uint64_t until{kNever};  // simulated ticks of the trial
  };
  struct Work;
  void run_pass(std::int32_t row, const record::PassRow& pass,
                const std::shared_ptr<BoneStage>& stage, const Onlookers& onlookers,
                ReplayVerdict& verdict) const;
  void run_own(const record::PassRow& pass, Work& work) const;
  void run_led(const record::PassRow& pass, Work& work) const;
  void check_end(std::int32_t row, const bone::Simulator& simulator, ReplayVerdict& verdict) const;
  std::shared_ptr<BoneStage> make_stage(int trial, std::uint64_t first, bool drawn) const;

  record::SessionReader reader_;
  BoneDefinition definition_;
  std::vector<record::PassRow> passes_;
  std::vector<record::ProcedureRow> procedures_;
  std::vector<record::RemovalRow> removals_;
  std::vector<record::SplitRow> splits_;
  std::vector<record::TearRow> tears_;
  std::vector<record::DeviceRow> second_;  // of the second device; none where there is one
  std::vector<record::FieldRow> field_;
  std::vector<record::PieceRow> pieces_;
  std::vector<record::ScrewRow> screws_;
  std::vector<record::LedRow> led_;        // none where the bone was the session's own
  std::vector<record::TuningRow> tuning_;  // none where no pilot was tuned
  std::vector<std::shared_ptr<const bone::BoneModel>> bones_;
};

}  // namespace haptrial::protocols
