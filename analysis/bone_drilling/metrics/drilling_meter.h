#pragma once

#include <vector>

#include "analysis/bone_drilling/metrics/achieved.h"
#include "analysis/bone_drilling/metrics/injuries.h"
#include "analysis/bone_drilling/metrics/procedure.h"
#include "analysis/bone_drilling/metrics/usage.h"
#include "analysis/bone_drilling/metrics/visibility.h"

namespace haptrial::analysis::drilling {

/// All that is measured while one goes along with a drilling: the same object in the analysis of a
/// file and in a session. A visitor of visit_in_order(). One thread, not the servo thread.
class DrillingMeter {
 public:
  DrillingMeter(std::shared_ptr<const bone::BoneModel> bone, const Eigen::Isometry3d& pose_WB,
                const std::vector<ProcedureTool>& tools, double rate, StudyBones& bones,
                const ProcedurePlans& plans);

  void view(const View& view);
  void crumb(const Debris& crumb);
  void tick(const ToolTick& tick);
  void removal(const Removal& removal);
  void cut(const Removal& cut);
  /// Rows of a list in their order; how they mix with those of others does not matter.
  void add(const record::PieceRow& row) { achieved_.add(row); }
  void add(const record::ScrewRow& row) { achieved_.add(row); }

  double time() const noexcept { return usage_.time(); }  // [s]
  Usage usage() const { return usage_.usage(); }
  const Visibility& visibility() const noexcept { return visibility_.visibility(); }
  const InjuryMeter& injuries() const noexcept { return injuries_; }
  Achieved achieved() const { return achieved_.achieved(); }

 private:
  BurrOnTick burr() const noexcept;  // on the last tick

  std::vector<ProcedureTool> tools_;
  UsageMeter usage_;
  VisibilityMeter visibility_;
  InjuryMeter injuries_;
  AchievedMeter achieved_;
  ToolTick last_;
  bool any_{false};
  std::vector<bone::Voxel> taken_;
};

}  // namespace haptrial::analysis::drilling
