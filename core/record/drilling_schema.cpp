#include <array>

#include "core/record/columns.h"
#include "core/record/schema.h"

namespace haptrial::record {
namespace {

using namespace columns;

constexpr std::array kTool{
    u64("sequence", "tick number, as in /samples"),
    f32("orientation_w", "1", "unit quaternion from the handle's frame to the world",
        kOrientationResolution),
    f32("orientation_x", "1", "likewise", kOrientationResolution),
    f32("orientation_y", "1", "likewise", kOrientationResolution),
    f32("orientation_z", "1", "likewise", kOrientationResolution),
    i32("buttons", "of the device; bit i: button i is pressed"),
    i32("keys", "of the window; bit i: function i is held"),
    f32("pedal", "1", "how far an analog pedal is down", kPedalResolution),
    i32("tool", "in hand, from 0 in the definition's order"),
    u8("mode", "0 tool, 1 the camera moves, 2 it turns, 3 a piece is carried"),
    u8("active", "1 where the bone was simulated on this tick"),
    u8("power", "1 where the burr turns or the suction sucks"),
    i32("piece", "of bone that is carried; -1: none"),
    i32("immersed", "samples of the tool in bone"),
    f32("removed", "voxel", "density that burr and cut plane took in this tick"),
    f32("contact_x", "N", "contact force before any limit, in the world frame", kForceResolution),
    f32("contact_y", "N", "contact force before any limit, in the world frame", kForceResolution),
    f32("contact_z", "N", "contact force before any limit, in the world frame", kForceResolution),
};

constexpr std::array kRemovals{
    u64("sequence", "tick on which the voxel was emptied"),
    i32("piece", "that held it, from 0"),
    i32("i", "voxel along x"),
    i32("j", "voxel along y"),
    i32("k", "voxel along z"),
    u8("label", "of /structures"),
    f32("force", "N", "magnitude of the contact force"),
    f32("speed", "m/s", "of the tool tip"),
};

constexpr std::array kCamera{
    u64("sequence", "tick from which on the scene was seen so"),
    i64("time_ns", "ns", "since the first tick of the session"),
    f64("eye_x", "m", "in the world frame"),
    f64("eye_y", "m", "in the world frame"),
    f64("eye_z", "m", "in the world frame"),
    f64("target_x", "m", "what it looks at, in the world frame"),
    f64("target_y", "m", "likewise"),
    f64("target_z", "m", "likewise"),
    f64("up_x", "1", "direction that is up in the picture"),
    f64("up_y", "1", "likewise"),
    f64("up_z", "1", "likewise"),
    f64("field_of_view", "rad", "vertical"),
};

constexpr std::array kSplits{
    u64("sequence", "tick on which the part was separated"),
    i32("from", "piece that held the part"),
    i32("to", "the new piece; -1 where the part turned to dust"),
    i32("i", "along x, of a voxel of the part"),
    i32("j", "along y"),
    i32("k", "along z"),
};

constexpr std::array kBones{
    i32("bone", "from 0"),
    text("name", kNameBytes, "of the bone"),
    text("source", kTextBytes, "where it comes from"),
    i32("size_x", "voxels of the grid"),
    i32("size_y", "voxels of the grid"),
    i32("size_z", "voxels of the grid"),
    f64("origin_x", "m", "centre of voxel (0, 0, 0) in the bone frame"),
    f64("origin_y", "m", "likewise"),
    f64("origin_z", "m", "likewise"),
    f64("spacing", "m", "edge of a voxel"),
};

constexpr std::array kStructures{
    i32("bone", "row of /bones"),
    i32("label", "of voxels"),
    text("name", kNameBytes, "of the structure"),
    f32("red", "1", "colour, 0 to 1"),
    f32("green", "1", "likewise"),
    f32("blue", "1", "likewise"),
    f64("hardness", "1", "removal is this many times slower than in bone"),
    u8("vital", "1 where touching it is an injury"),
};

constexpr std::array kBoneRuns{
    i32("bone", "row of /bones"),
    u64("first", "voxel, i + size_x (j + size_y k)"),
    i32("count", "voxels from there on that have the label"),
    u8("label", "of /structures"),
};

constexpr std::array kBoneDensities{
    i32("bone", "row of /bones"),
    u64("voxel", "i + size_x (j + size_y k)"),
    f32("density", "1", "where it is not 1"),
};

constexpr std::array kProcedures{
    i32("pass", "row of /trials"),
    i32("bone", "row of /bones"),
    i32("pieces", "that the bone has come to"),
    u64("emptied", "voxels since the bone was new"),
    f64("before", "voxel", "density of the bone when it was new"),
    f64("left", "voxel", "density of bone in all pieces"),
    f64("cut", "voxel", "density taken by the cut plane"),
    f64("dust", "voxel", "bone dust that lies about"),
    f64("suctioned", "voxel", "bone dust that was sucked off"),
    f64("fallen", "voxel", "bone dust that left the region where it is followed"),
    u64("checksum", "of all densities; see the page on session files"),
};

// Chunks of different tables never inflate to the same size: recovery knows them by it.
constexpr TableSchema kToolSchema{"tool", "the tool on each tick of the servo loop", 4096, kTool};
constexpr TableSchema kRemovalsSchema{
    "removals", "one row for each voxel that a burr or the cut plane emptied", 500, kRemovals};
constexpr TableSchema kCameraSchema{"camera", "one row for each change of the view", 64, kCamera};
constexpr TableSchema kSplitsSchema{"splits", "parts that were separated: voxels that say which",
                                    1024, kSplits};
constexpr TableSchema kBonesSchema{"bones", "the bones before anything touched them", 8, kBones};
constexpr TableSchema kStructuresSchema{"structures", "what the labels of a bone stand for", 32,
                                        kStructures};
constexpr TableSchema kBoneRunsSchema{"bone_runs", "the labels of a bone's voxels", 8192,
                                      kBoneRuns};
constexpr TableSchema kBoneDensitiesSchema{"bone_densities", "densities of voxels that are not 1",
                                           8192, kBoneDensities};
constexpr TableSchema kProceduresSchema{"procedures", "how a drilling stood at the end of a pass",
                                        16, kProcedures};

}  // namespace

const TableSchema& schema(DrillingTable table) {
  static constexpr std::array<const TableSchema*, kDrillingTables> kAll{
      &kToolSchema,       &kRemovalsSchema, &kCameraSchema,        &kSplitsSchema,    &kBonesSchema,
      &kStructuresSchema, &kBoneRunsSchema, &kBoneDensitiesSchema, &kProceduresSchema};
  return *kAll[static_cast<std::size_t>(table)];
}

}  // namespace haptrial::record
