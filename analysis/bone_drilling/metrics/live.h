#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "analysis/bone_drilling/metrics/achieved.h"
#include "analysis/bone_drilling/metrics/drilling_meter.h"
#include "analysis/bone_drilling/metrics/injuries.h"
#include "analysis/bone_drilling/metrics/study_bones.h"

namespace haptrial::analysis::drilling {

/// How a drilling stands.
struct LiveFigures {
  double time{0.0};                     // [s]
  double drilling{0.0};                 // [s]
  double removed{0.0};                  // bone [m^3]
  std::uint64_t voxels{0};              // emptied
  std::optional<double> visible_share;  // of them
  std::uint64_t injured_voxels{0};      // of vital structures, emptied
  std::vector<Injury> injuries;         // by vital structure
  std::optional<double> mean_force;     // while drilling [N]
  Achieved achieved;

  bool operator==(const LiveFigures&) const = default;
};

/// The metrics of a drilling while it runs, from the rows that go into the session file: after the
/// last one they are what an analysis of the file gives, bit for bit
/// (LiveMetricsTest.EqualsTheAnalysisOfTheFile). One thread, the session's, not the servo thread.
///
/// The rows of each table come in their order, those of different tables in any: give all that the
/// logs hold, then say up to which tick that is everything.
class LiveMetrics {
 public:
  /// One for each bone; a drilling that was broken off and goes on stays with its object.
  /// @param scale, handle  as ProcedureSetup has them
  LiveMetrics(const std::shared_ptr<const bone::BoneModel>& bone, const Eigen::Isometry3d& pose_WB,
              const std::vector<ProcedureTool>& tools, double scale, double rate,
              const Eigen::Vector3d& handle = Eigen::Vector3d::UnitZ(),
              const ProcedurePlans& plans = {});

  /// Rows of the same ticks; those on which no bone was simulated are passed over.
  /// @throws std::invalid_argument where they are not of the same ticks.
  void add(std::span<const record::Sample> samples, std::span<const record::ToolRow> tool);
  void add(std::span<const record::RemovalRow> rows);
  void add(std::span<const record::CameraRow> rows);
  void add(std::span<const record::SplitRow> rows);
  /// These count at once.
  void add(std::span<const record::PieceRow> rows);
  void add(std::span<const record::ScrewRow> rows);

  /// Adds the bone that was removed before the first of these rows, in an earlier run of the
  /// session.
  void add(const Procedure& earlier);

  /// All rows up to this tick have been given: measures them.
  void advance(std::uint64_t through);

  LiveFigures figures() const;

 private:
  StudyBones bones_;
  DrillingMeter meter_;
  double scale_;
  Eigen::Vector3d handle_;
  struct {
    std::vector<ToolTick> ticks;
    std::vector<Removal> removals;
    std::vector<Removal> cuts;
    std::vector<View> views;
    std::vector<Debris> crumbs;
  } waiting_;
};

}  // namespace haptrial::analysis::drilling
