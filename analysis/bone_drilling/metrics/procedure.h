#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/bone/drill/burr_shape.h"
#include "core/bone/model/bone_model.h"
#include "core/bone/model/bone_volume.h"
#include "core/bone/record/bone_rows.h"
#include "core/bone/record/drilling_tables.h"
#include "core/record/read/session_reader_forward.h"
#include "core/record/rows/session_types.h"
#include "core/subject/drilling/fragment_plan.h"

namespace haptrial::subject {
struct CavityPlan;
}

namespace haptrial::analysis::drilling {

/// A tool as far as metrics need it.
struct ProcedureTool {
  std::string name;
  double burr_radius{0.0};                         // [m]; 0: no burr
  std::shared_ptr<const bone::BurrShape> shape{};  // of a burr that is no ball; else null
};

/// The plans of a procedure on its bone.
struct ProcedurePlans {
  std::shared_ptr<const subject::CavityPlan> cavity;  // null: the definition has no [cavity]
  std::optional<subject::FragmentPlan> fragment;      // nothing: it has no [osteotomy]
};

/// Facts of a session that its definition has and its tables do not.
struct ProcedureSetup {
  std::string group;           // of the participant
  std::string session_name{};  // empty: the definition names none
  /// X_WB, how a bone lies in the scene; null: B is W.
  std::function<Eigen::Isometry3d(const geometry::VoxelGrid&)> pose_WB;
  double scale{1.0};  // the device's motions are this many times the scene's > 0
  /// Direction from the tip along the handle, in the frame of the device's orientation. Any length
  /// but 0.
  Eigen::Vector3d handle{Eigen::Vector3d::UnitZ()};
  std::vector<ProcedureTool> tools;  // in the definition's order
  /// The plans on a bone; empty: there are none.
  std::function<ProcedurePlans(const std::shared_ptr<const bone::BoneModel>&)> plans;
  bool of_cases{false};  // conditions are the cases of a curriculum
};

/// One tick of a drilling; the tip in the scene's frame W.
struct ToolTick {
  std::uint64_t sequence{0};
  Eigen::Vector3d position{Eigen::Vector3d::Zero()};  // [m]
  Eigen::Vector3d velocity{Eigen::Vector3d::Zero()};  // [m/s]
  Eigen::Vector3f axis{Eigen::Vector3f::UnitZ()};     // from the tip along the handle, unit length
  double force{0.0};                                  // magnitude of the contact force [N]
  double removed{0.0};                                // density on this tick [voxels]
  std::int32_t tool{0};                               // in hand, of Procedure::tools
  bool drives_tool{true};  // the hand does not steer the camera or a piece
  bool power{false};       // the burr turns
  bool in_bone{false};     // at least one sample of the burr

  /// The hand drives a burr that turns and is in bone, where the tool is a burr.
  bool drills() const noexcept { return drives_tool && power && in_bone; }
};

/// A voxel that a tool emptied.
struct Removal {
  std::uint64_t sequence{0};
  bone::Voxel voxel{bone::Voxel::Zero()};
  std::uint8_t label{0};
  double force{0.0};  // [N]
  double speed{0.0};  // of the tip [m/s]
};

/// How the scene was seen from a tick on.
struct View {
  std::uint64_t sequence{0};
  Eigen::Vector3d eye{Eigen::Vector3d::Zero()};     // in W [m]
  Eigen::Vector3d target{Eigen::Vector3d::Zero()};  // in W [m]
  double field_of_view{0.6};                        // vertical [rad]
};

/// A voxel of a part that turned to dust, with all that hung together with it.
struct Debris {
  std::uint64_t sequence{0};
  bone::Voxel voxel{bone::Voxel::Zero()};
};

/// Soft tissue that was torn.
struct Torn {
  std::uint64_t sequence{0};
  std::uint8_t label{0};
  bool by_suction{false};
  double force{0.0};                               // [N]
  Eigen::Vector3d place{Eigen::Vector3d::Zero()};  // in W [m]
};

/// A virtual surgeon begins to work on something.
struct BegunWork {
  double time{0.0};  // of the procedure [s]
  std::string work;
};

/// Identity of a drilling: who drilled, which bone, and how it ended.
struct ProcedureIdentity {
  std::string session;  // name of the file
  std::string participant;
  std::string group;
  int session_number{1};       // of the participant's sessions, from 1
  std::string session_name{};  // in the definition's words; empty: it has none
  std::string case_name{};     // of a curriculum; empty: there is none
  int number{1};               // of the session's procedures: the trial, from 1
  bool simulated{true};        // the participant is a virtual subject
  bool completed{true};        // its last pass came to its end
  std::shared_ptr<const bone::BoneModel> bone;
  /// Heat and blood since the bone was new; none where the definition has neither.
  std::optional<record::FieldRow> field;
};

/// One drilling of one participant: everything that metrics are made from. Rows of every list are
/// in ascending order of their sequence numbers, and of one tick a crumb went before the removals
/// and these before the cuts.
///
/// Voxels are where they were at the beginning, also those of pieces that were carried.
struct Procedure : ProcedureIdentity {
  double rate{1000.0};  // of ticks [Hz]
  Eigen::Isometry3d pose_WB{Eigen::Isometry3d::Identity()};
  std::vector<ProcedureTool> tools;
  std::vector<ToolTick> ticks;
  std::vector<Removal> removals;  // by burrs
  std::vector<Removal> cuts;      // by the cut plane, which has no force
  std::vector<View> views;
  std::vector<Debris> crumbs;
  std::vector<Torn> tears;
  std::vector<record::PieceRow> pieces;  // none where the definition has no [osteotomy]
  std::vector<record::ScrewRow> screws;  // likewise
  ProcedurePlans plans;
  std::vector<BegunWork> work;  // of a virtual surgeon; none: nobody knows

  /// Null out of range.
  const ProcedureTool* tool(std::int32_t tool) const noexcept;
  /// The radius of a tool's burr; 0 for a tool that is none, or out of range [m].
  double burr_radius(std::int32_t tool) const noexcept;
};

class StudyBones;

/// The drillings of a session file in the order of their trials, those of practice left out. A
/// drilling that was broken off and went on is one procedure with the ticks of all its passes; of
/// one that was begun anew on a fresh bone only the last bone counts.
/// @param bones  where equal bones of several files become one; may be null
/// @throws InputError where the file is damaged, has no drillings, or a table names what is not
/// there; std::invalid_argument for a scale that is not above 0.
std::vector<Procedure> load_procedures(const record::SessionReader& file,
                                       const ProcedureSetup& setup, StudyBones* bones = nullptr);

// Rows of a session file as metrics use them; of rows that are not in a file yet, what the file
// will give.
ToolTick tick_of(const record::Sample& sample, const record::ToolRow& tool, double scale,
                 const Eigen::Vector3d& handle = Eigen::Vector3d::UnitZ());
Removal removal_of(const record::RemovalRow& row);
View view_of(const record::CameraRow& row);

struct CountedPass {
  std::size_t row;  // of /passes
  record::PassRow pass;
};

/// The passes of each trial of a drilling session that count, by trial: those of practice are left
/// out, and of a drilling that was begun anew on a fresh bone those on earlier bones.
/// @throws InputError where the file is damaged
std::map<std::int32_t, std::vector<CountedPass>> counted_passes(const record::SessionReader& file);

}  // namespace haptrial::analysis::drilling
