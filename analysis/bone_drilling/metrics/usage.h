#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/bone_drilling/metrics/procedure.h"

namespace haptrial::analysis::drilling {

/// How a tool was used.
struct ToolUse {
  std::string tool;
  double in_hand{0.0};   // [s]
  double drilling{0.0};  // [s]
  double removed{0.0};   // bone in voxels that were emptied while it was in hand [m^3]
};

/// Bone of one structure that was removed.
struct StructureRemoval {
  std::string structure;
  std::uint8_t label{0};
  std::uint64_t voxels{0};  // emptied
  double volume{0.0};       // that was in them [m^3]
};

/// Time, bone and tools of a procedure. Drilling is every tick on which the hand drives a burr that
/// turns and is in bone.
struct Usage {
  double time{0.0};                          // [s]
  double drilling{0.0};                      // [s]
  double removed{0.0};                       // bone, also from voxels that were not emptied [m^3]
  std::vector<ToolUse> tools;                // (tools)
  std::vector<StructureRemoval> structures;  // (structures), by label
  int tool_changes{0};
  std::optional<double> mean_force;      // while drilling [N]
  std::optional<double> greatest_force;  // while drilling [N]
  double camera_path{0.0};               // of the eye [m]
  double camera_turn{0.0};               // of the line of sight [rad]
  int camera_moves{0};                   // times that the view began to change
};

/// Meter of tools that goes along with a drilling. One thread, not the servo thread.
class UsageMeter {
 public:
  /// @param rate  of ticks [Hz]
  UsageMeter(std::shared_ptr<const bone::BoneModel> bone, const std::vector<ProcedureTool>& tools,
             double rate);

  void tick(const ToolTick& tick);
  void remove(const Removal& removal);  // of a burr or the cut plane, after its tick
  void view(const View& view);

  Usage usage() const;
  double time() const noexcept;  // [s]

 private:
  std::shared_ptr<const bone::BoneModel> bone_;
  double period_;  // [s]
  Usage usage_;
  std::vector<std::uint64_t> tool_ticks_, tool_drilling_;  // (tools)
  std::vector<bool> burrs_;                                // (tools)
  std::uint64_t ticks_{0};
  std::uint64_t drilling_{0};
  double force_sum_{0.0};
  double removed_{0.0};  // [voxels]
  std::int32_t tool_{-1};
  std::optional<View> view_;
  std::uint64_t moved_{0};  // when the view last changed
  bool has_moved_{false};
};

Usage usage(const Procedure& procedure);

}  // namespace haptrial::analysis::drilling
