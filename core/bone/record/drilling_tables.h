#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/record/rows/rows.h"
#include "core/record/rows/session_types.h"
#include "core/record/table/table.h"

namespace haptrial::record {

inline constexpr Phase kDrillingPhase{"drilling"};

/// Records of a drilling session beside the tables of every session (docs/session-file.md). Each
/// type is a row of one table.

/// One servo tick, a row of /tool; its sequence numbers are those of /samples. Goes through a block
/// log.
struct ToolRow {
  std::uint64_t sequence{0};
  Eigen::Quaterniond orientation{Eigen::Quaterniond::Identity()};  // as the device gave it, in W
  std::uint32_t buttons{0};                                        // of the device, bit i: button i
  std::uint32_t keys{0};     // of the window, bit i: function i is held
  double pedal{0.0};         // 0 to 1
  std::int32_t tool{0};      // in hand, from 0, in the definition's order
  std::uint8_t mode{0};      // 0 tool, 1 camera moves, 2 camera turns, 3 carries a piece
  bool active{false};        // the bone was simulated on this tick
  bool power{false};         // the burr turns, the suction sucks
  std::int32_t piece{-1};    // of bone that is carried; -1: none
  std::int32_t immersed{0};  // samples of the tool in bone
  double removed{0.0};       // density that burr and cut plane took in this tick [voxels]
  Eigen::Vector3d contact{Eigen::Vector3d::Zero()};  // force before any limit, in W [N]
};

/// One voxel that a tool emptied, a row of /removals. Goes through a block log.
struct RemovalRow {
  std::uint64_t sequence{0};            // of the tick
  std::int32_t piece{0};                // that held it
  std::array<std::int32_t, 3> voxel{};  // i, j, k
  std::uint8_t label{0};
  bool cut{false};    // by the cut plane, which has no force; else by a burr
  double force{0.0};  // magnitude of the contact force [N]
  double speed{0.0};  // of the tool tip [m/s]
};

/// How the scene was seen from a tick on, a row of /camera. Goes through a block log.
struct CameraRow {
  std::uint64_t sequence{0};
  std::int64_t time_ns{0};
  Eigen::Vector3d eye{Eigen::Vector3d::Zero()};     // in W [m]
  Eigen::Vector3d target{Eigen::Vector3d::Zero()};  // in W [m]
  Eigen::Vector3d up{Eigen::Vector3d::UnitY()};
  double field_of_view{0.6};  // vertical [rad]
};

/// One voxel of a part that was separated, a row of /splits. All that hung together with a row's
/// voxel through faces went with it.
struct SplitRow {
  std::uint64_t sequence{0};  // of the tick on which it went
  std::int32_t from{0};       // piece
  std::int32_t to{0};         // the new piece; -1: a crumb that turned to dust
  std::array<std::int32_t, 3> voxel{};
};

/// A bone as it was before anything touched it, a row of /bones; its voxels are in /bone_runs.
struct BoneRow {
  std::int32_t bone{0};  // from 0
  std::string name;
  std::string source;
  std::array<std::int32_t, 3> size{};               // of the grid [voxels]
  Eigen::Vector3d origin{Eigen::Vector3d::Zero()};  // centre of voxel (0, 0, 0), in B [m]
  double spacing{0.0};                              // [m]
};

/// Meaning of a label of a bone, a row of /structures.
struct StructureRow {
  std::int32_t bone{0};
  std::int32_t label{0};
  std::string name;
  std::array<double, 3> colour{};
  double hardness{1.0};
  bool vital{false};
};

/// Voxels that follow one another along x, y, z and have one label, a row of /bone_runs. Label 0
/// has no rows.
struct BoneRunRow {
  std::int32_t bone{0};
  std::uint64_t first{0};  // voxel index, i + size_x (j + size_y k)
  std::int32_t count{0};
  std::uint8_t label{0};
};

/// The density of a voxel where it is not 1, a row of /bone_densities.
struct BoneDensityRow {
  std::int32_t bone{0};
  std::uint64_t voxel{0};
  float density{0.0F};
};

/// How a drilling stood at the end of a pass, a row of /procedures. Amounts are sums of density in
/// voxels.
struct ProcedureRow {
  std::int32_t pass{0};  // row of /trials
  std::int32_t bone{0};
  std::int32_t pieces{1};
  std::uint64_t emptied{0};   // voxels since the bone was new
  double before{0.0};         // of bone, when it was new
  double left{0.0};           // of bone, in all pieces
  double cut{0.0};            // taken by the cut plane
  double dust{0.0};           // that lies about
  double suctioned{0.0};      // dust
  double fallen{0.0};         // dust, out of the region where it is followed
  std::uint64_t checksum{0};  // of all densities
};

/// Everything that says what a bone was.
struct BoneRecord {
  BoneRow bone;
  std::vector<StructureRow> structures;
  std::vector<BoneRunRow> runs;
  std::vector<BoneDensityRow> densities;
};

class SessionReader;

/// The tables of drillings, in the order in which they are created.
const TableList& drilling_tables();

/// The rows that bones have from the beginning; they point into `bones`.
std::vector<Rows> rows_of(std::span<const BoneRecord> bones);

/// Whether the file has these tables.
bool drills(const SessionReader& file);
/// The bones of the session, in their order.
std::vector<BoneRecord> recorded_bones(const SessionReader& file);

template <>
const Table<ToolRow>& table_of<ToolRow>();
template <>
const Table<RemovalRow>& table_of<RemovalRow>();
template <>
const Table<CameraRow>& table_of<CameraRow>();
template <>
const Table<SplitRow>& table_of<SplitRow>();
template <>
const Table<BoneRow>& table_of<BoneRow>();
template <>
const Table<StructureRow>& table_of<StructureRow>();
template <>
const Table<BoneRunRow>& table_of<BoneRunRow>();
template <>
const Table<BoneDensityRow>& table_of<BoneDensityRow>();
template <>
const Table<ProcedureRow>& table_of<ProcedureRow>();

}  // namespace haptrial::record
