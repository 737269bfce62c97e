#include "core/bone/record/drilling_tables.h"

#include "core/bone/record/tool_rows.h"
#include "core/record/read/session_reader.h"

namespace haptrial::record {
namespace {

constexpr const char* kGroup = "bone_drilling";
constexpr std::int64_t kSince = 3;

using Names3 = std::array<const char*, 3>;
constexpr Names3 kVoxel{"i", "j", "k"};

EnumText modes() {
  return EnumText(
      {{0, "tool"}, {1, "the camera moves"}, {2, "it turns"}, {3, "a piece is carried"}});
}

}  // namespace

template <>
const Table<ToolRow>& table_of<ToolRow>() {
  using R = ToolRow;
  using T = Table<R>;
  static const T table(
      {"tool",
       "the tool on each tick of the servo loop",
       4096,
       RowsOf::kEachTick,
       {"sequence"},
       kGroup,
       kSince},
      {T::column("sequence", &R::sequence, "1", "tick number, as in /samples"),
       turn_columns(&R::orientation, "unit quaternion from the handle's frame to the world"),
       T::column("buttons", &R::buttons, "1", "of the device; bit i: button i is pressed"),
       T::column("keys", &R::keys, "1", "of the window; bit i: function i is held"),
       T::rounded("pedal", &R::pedal, "1", "how far an analog pedal is down", kPedalResolution),
       T::column("tool", &R::tool, "1", "in hand, from 0 in the definition's order"),
       T::code("mode", &R::mode, modes(),
               "0 tool, 1 the camera moves, 2 it turns, 3 a piece is carried"),
       T::column("active", &R::active, "1", "1 where the bone was simulated on this tick"),
       T::column("power", &R::power, "1", "1 where the burr turns or the suction sucks"),
       T::column("piece", &R::piece, "1", "of bone that is carried; -1: none"),
       T::column("immersed", &R::immersed, "1", "samples of the tool in bone"),
       T::rounded("removed", &R::removed, "voxel",
                  "density that burr and cut plane took in this tick"),
       T::rounded_elements(Names3{"contact_x", "contact_y", "contact_z"}, &R::contact, "N",
                           "contact force before any limit, in the world frame",
                           kForceResolution)});
  return table;
}

template <>
const Table<RemovalRow>& table_of<RemovalRow>() {
  using R = RemovalRow;
  using T = Table<R>;
  static const T table(
      {"removals",
       "one row for each voxel that a burr or the cut plane emptied",
       500,
       RowsOf::kTick,
       {"sequence"},
       kGroup,
       kSince},
      {T::column("sequence", &R::sequence, "1", "tick on which the voxel was emptied"),
       T::column("piece", &R::piece, "1", "that held it, from 0"),
       T::elements(kVoxel, &R::voxel, "1",
                   Names3{"voxel along x", "voxel along y", "voxel along z"}),
       T::column("label", &R::label, "1", "of /structures"),
       T::rounded("force", &R::force, "N", "magnitude of the contact force; 0 of a cut"),
       T::rounded("speed", &R::speed, "m/s", "of the tool tip"),
       T::since(5, T::column("cut", &R::cut, "1", "1: by the cut plane, 0: by a burr"))},
      [](R& row, std::int64_t version) {
        row.cut = version < 5 ? row.force == 0.0 : row.cut;  // a burr has a force
      });
  return table;
}

template <>
const Table<CameraRow>& table_of<CameraRow>() {
  using R = CameraRow;
  using T = Table<R>;
  static const T table(
      {"camera",
       "one row for each change of the view",
       64,
       RowsOf::kTick,
       {"sequence"},
       kGroup,
       kSince},
      {T::column("sequence", &R::sequence, "1", "tick from which on the scene was seen so"),
       T::column("time_ns", &R::time_ns, "ns", "since the first tick of the session"),
       T::elements(Names3{"eye_x", "eye_y", "eye_z"}, &R::eye, "m", "in the world frame"),
       T::elements(Names3{"target_x", "target_y", "target_z"}, &R::target, "m",
                   Names3{"what it looks at, in the world frame", "likewise", "likewise"}),
       T::elements(Names3{"up_x", "up_y", "up_z"}, &R::up, "1",
                   Names3{"direction that is up in the picture", "likewise", "likewise"}),
       T::column("field_of_view", &R::field_of_view, "rad", "vertical")});
  return table;
}

template <>
const Table<SplitRow>& table_of<SplitRow>() {
  using R = SplitRow;
  using T = Table<R>;
  static const T table(
      {"splits",
       "parts that were separated: voxels that say which",
       1024,
       RowsOf::kTick,
       {"sequence"},
       kGroup,
       kSince},
      {T::column("sequence", &R::sequence, "1", "tick on which the part was separated"),
       T::column("from", &R::from, "1", "piece that held the part"),
       T::column("to", &R::to, "1", "the new piece; -1 where the part turned to dust"),
       T::elements(kVoxel, &R::voxel, "1",
                   Names3{"along x, of a voxel of the part", "along y", "along z"})});
  return table;
}

template <>
const Table<BoneRow>& table_of<BoneRow>() {
  using R = BoneRow;
  using T = Table<R>;
  static const T table(
      {"bones",
       "the bones before anything touched them",
       8,
       RowsOf::kSession,
       {"bone"},
       kGroup,
       kSince},
      {T::column("bone", &R::bone, "1", "from 0"),
       T::text("name", &R::name, kNameBytes, "of the bone"),
       T::text("source", &R::source, kTextBytes, "where it comes from"),
       T::elements(Names3{"size_x", "size_y", "size_z"}, &R::size, "1", "voxels of the grid"),
       T::elements(Names3{"origin_x", "origin_y", "origin_z"}, &R::origin, "m",
                   Names3{"centre of voxel (0, 0, 0) in the bone frame", "likewise", "likewise"}),
       T::column("spacing", &R::spacing, "m", "edge of a voxel")});
  return table;
}

template <>
const Table<StructureRow>& table_of<StructureRow>() {
  using R = StructureRow;
  using T = Table<R>;
  static const T table(
      {"structures",
       "what the labels of a bone stand for",
       32,
       RowsOf::kSession,
       {"bone", "label"},
       kGroup,
       kSince},
      {T::column("bone", &R::bone, "1", "row of /bones"),
       T::column("label", &R::label, "1", "of voxels"),
       T::text("name", &R::name, kNameBytes, "of the structure"),
       T::rounded_elements(Names3{"red", "green", "blue"}, &R::colour, "1",
                           Names3{"colour, 0 to 1", "likewise", "likewise"}),
       T::column("hardness", &R::hardness, "1", "removal is this many times slower than in bone"),
       T::column("vital", &R::vital, "1", "1 where touching it is an injury")});
  return table;
}

template <>
const Table<BoneRunRow>& table_of<BoneRunRow>() {
  using R = BoneRunRow;
  using T = Table<R>;
  static const T table(
      {"bone_runs",
       "the labels of a bone's voxels",
       8192,
       RowsOf::kSession,
       {"bone", "first"},
       kGroup,
       kSince},
      {T::column("bone", &R::bone, "1", "row of /bones"),
       T::column("first", &R::first, "1", "voxel, i + size_x (j + size_y k)"),
       T::column("count", &R::count, "1", "voxels from there on that have the label"),
       T::column("label", &R::label, "1", "of /structures")});
  return table;
}

template <>
const Table<BoneDensityRow>& table_of<BoneDensityRow>() {
  using R = BoneDensityRow;
  using T = Table<R>;
  static const T table({"bone_densities",
                        "densities of voxels that are not 1",
                        8192,
                        RowsOf::kSession,
                        {"bone", "voxel"},
                        kGroup,
                        kSince},
                       {T::column("bone", &R::bone, "1", "row of /bones"),
                        T::column("voxel", &R::voxel, "1", "i + size_x (j + size_y k)"),
                        T::column("density", &R::density, "1", "where it is not 1")});
  return table;
}

template <>
const Table<ProcedureRow>& table_of<ProcedureRow>() {
  using R = ProcedureRow;
  using T = Table<R>;
  static const T table(
      {"procedures",
       "how a drilling stood at the end of a pass",
       16,
       RowsOf::kEndedPass,
       {"pass"},
       kGroup,
       kSince},
      {T::column("pass", &R::pass, "1", "row of /trials"),
       T::column("bone", &R::bone, "1", "row of /bones"),
       T::column("pieces", &R::pieces, "1", "that the bone has come to"),
       T::column("emptied", &R::emptied, "1", "voxels since the bone was new"),
       T::column("before", &R::before, "voxel", "density of the bone when it was new"),
       T::column("left", &R::left, "voxel", "density of bone in all pieces"),
       T::column("cut", &R::cut, "voxel", "density taken by the cut plane"),
       T::column("dust", &R::dust, "voxel", "bone dust that lies about"),
       T::column("suctioned", &R::suctioned, "voxel", "bone dust that was sucked off"),
       T::column("fallen", &R::fallen, "voxel",
                 "bone dust that left the region where it is followed"),
       T::column("checksum", &R::checksum, "1",
                 "of all densities; see the page on session files")});
  return table;
}

const TableList& drilling_tables() {
  static const TableList tables{
      &table_of<ToolRow>(),    &table_of<RemovalRow>(),     &table_of<CameraRow>(),
      &table_of<SplitRow>(),   &table_of<BoneRow>(),        &table_of<StructureRow>(),
      &table_of<BoneRunRow>(), &table_of<BoneDensityRow>(), &table_of<ProcedureRow>()};
  return tables;
}

std::vector<Rows> rows_of(std::span<const BoneRecord> bones) {
  std::vector<Rows> rows;
  for (const BoneRecord& bone : bones) {
    rows.emplace_back(std::span(&bone.bone, 1));
    rows.emplace_back(std::span(bone.structures));
    rows.emplace_back(std::span(bone.runs));
    rows.emplace_back(std::span(bone.densities));
  }
  return rows;
}

bool drills(const SessionReader& file) { return file.has(table_of<ToolRow>()); }

std::vector<BoneRecord> recorded_bones(const SessionReader& file) {
  std::vector<BoneRecord> bones;
  for (const BoneRow& bone : file.rows<BoneRow>()) {
    bones.push_back({bone, {}, {}, {}});
  }
  const auto share_out = [&]<class Row>(std::vector<Row> BoneRecord::*to) {
    for (Row& row : file.rows<Row>()) {
      if (row.bone >= 0 && static_cast<std::size_t>(row.bone) < bones.size()) {
        (bones[static_cast<std::size_t>(row.bone)].*to).push_back(std::move(row));
      }
    }
  };
  share_out(&BoneRecord::structures);
  share_out(&BoneRecord::runs);
  share_out(&BoneRecord::densities);
  return bones;
}

}  // namespace haptrial::record
