#pragma once

#include <filesystem>
#include <vector>

#include "core/base/random.h"
#include "core/record/hdf5/session_writer.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::test {

inline record::SessionInfo drilling_info() {
  record::SessionInfo info;
  info.subject = "P07";
  info.definition = "# made by hand";
  info.definition_name = "drilling.toml";
  info.device = "virtual";
  info.clock = "simulated";
  info.start_utc = "2026-11-20T09:30:00Z";
  return info;
}

/// The rows of one drilling as a session has them, in their order.
struct DrillingRows {
  std::vector<record::Sample> samples;
  std::vector<record::ToolRow> tool;
  std::vector<record::RemovalRow> removals;
  std::vector<record::CameraRow> camera;
  std::vector<record::SplitRow> splits;
};

/// 12 x 10 x 6 voxels of 1 mm; a nerve, vital, runs through it along x.
inline record::BoneRecord block_record(std::int32_t number) {
  record::BoneRecord record;
  record.bone = {number, "block", "made by hand", {12, 10, 6}, {0.0, 0.0, 0.0}, 1e-3};
  record.structures = {{number, 1, "bone", {0.9, 0.8, 0.7}, 1.0, false},
                       {number, 2, "nerve", {1.0, 1.0, 0.0}, 1.0, true}};
  const std::uint64_t nerve = 12 * (5 + 10 * 2);
  record.runs = {{number, 0, static_cast<std::int32_t>(nerve), 1},
                 {number, nerve, 12, 2},
                 {number, nerve + 12, static_cast<std::int32_t>(720 - nerve - 12), 1}};
  record.densities = {{number, 7, 0.25F}};
  return record;
}

/// A hand that wanders through the block, `ticks` ticks from number `first` on, as pass `pass`;
/// nothing is on a grid of the file. Every voxel goes once.
inline DrillingRows wander(std::uint64_t first, std::uint64_t ticks, std::int32_t pass,
                           RandomStream& random, std::vector<bool>& gone) {
  DrillingRows rows;
  Eigen::Vector3d place(5e-3, 4e-3, 6e-3);
  gone.resize(720, false);
  for (std::uint64_t n = first; n < first + ticks; ++n) {
    record::Sample sample;
    sample.sequence = n;
    sample.time_ns = static_cast<std::int64_t>(n) * 1000000;
    sample.pass = pass;
    sample.stage = record::Stage::kRun;
    for (int axis = 0; axis < 3; ++axis) {
      sample.velocity[axis] = random.uniform(-0.3, 0.3);
    }
    place = (place + 1e-3 * sample.velocity).cwiseMax(0.0).cwiseMin(11e-3);
    sample.position = 2.0 * place;  // of a device that moves twice as far
    record::ToolRow tool;
    tool.sequence = n;
    tool.active = true;
    tool.power = random.uniform() < 0.9;
    tool.tool = n % 400 < 300 ? 0 : 1;
    tool.mode = random.uniform() < 0.05 ? 1 : 0;
    tool.immersed = random.uniform() < 0.8 ? 100 : 0;
    tool.removed = random.uniform();
    tool.contact = {random.uniform(), random.uniform(), random.uniform()};
    rows.samples.push_back(sample);
    rows.tool.push_back(tool);
    const Eigen::Vector3i v = (place * 1e3).array().round().cast<int>();
    const auto index = static_cast<std::size_t>(v.x() + 12 * (v.y() + 10 * v.z()));
    if (v.y() < 10 && v.z() < 6 && v.x() < 12 && !gone[index]) {
      gone[index] = true;
      const bool nerve = v.y() == 5 && v.z() == 2;
      rows.removals.push_back({n,
                               0,
                               {v.x(), v.y(), v.z()},
                               static_cast<std::uint8_t>(nerve ? 2 : 1),
                               false,
                               tool.contact.norm(),
                               sample.velocity.norm()});
    }
    if ((n - first) % 97 == 0) {
      record::CameraRow view;
      view.sequence = n;
      view.eye = {random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), 0.2};
      rows.camera.push_back(view);
    }
    if ((n - first) % 500 == 499) {
      rows.splits.push_back({n, 0, n % 1000 == 999 ? -1 : 1, {v.x(), v.y(), 0}});
    }
  }
  return rows;
}

/// Writes a pass with `between` ticks after it on which nothing goes on.
inline void write_pass(record::SessionWriter& writer, const DrillingRows& rows,
                       record::PassRow pass, std::uint64_t between = 20) {
  pass.phase = record::kDrillingPhase;
  pass.first_sample = rows.samples.front().sequence;
  pass.last_sample = rows.samples.back().sequence;
  std::vector<record::Sample> samples = rows.samples;
  std::vector<record::ToolRow> tool = rows.tool;
  for (std::uint64_t n = 1; n <= between; ++n) {
    record::Sample sample;
    sample.sequence = pass.last_sample + n;
    sample.time_ns = static_cast<std::int64_t>(sample.sequence) * 1000000;
    record::ToolRow row;
    row.sequence = sample.sequence;
    row.active = false;
    samples.push_back(sample);
    tool.push_back(row);
  }
  writer.add(std::span<const record::ToolRow>(tool));
  writer.add(std::span<const record::RemovalRow>(rows.removals));
  writer.add(std::span<const record::CameraRow>(rows.camera));
  writer.add(std::span<const record::SplitRow>(rows.splits));
  writer.append(samples);
  writer.add_pass(pass);
}

}  // namespace haptrial::test
