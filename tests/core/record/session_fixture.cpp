#include "tests/core/record/session_fixture.h"

#include <cmath>
#include <cstring>

#include "core/base/random.h"
#include "core/bone/record/drilling_tables.h"
#include "core/record/rows/common_tables.h"

namespace haptrial::test {

using record::Sample;
using record::Stage;

record::SessionInfo example_info() {
  record::SessionInfo info;
  info.program_version = "0.1.0";
  info.program_commit = "0123abc";
  info.definition = "[trajectory]\nspeed = 0.016  # größer als 0\n";
  info.definition_name = "recall.toml";
  info.subject = "P07";
  info.seed = 0xFEDCBA9876543210u;
  info.device = "virtual";
  info.device_max_force = 8.5;
  info.device_workspace_radius = 0.16;
  info.clock = "simulated";
  info.rate = 1000.0;
  info.start_utc = "2026-11-20T09:30:00Z";
  info.simulated = true;
  info.participant.identifier = "P07";
  info.participant.handedness = "right";
  info.participant.age_band = "18-25";
  info.participant.consent_confirmed = "yes";
  info.participant.notes = "trägt Brille";
  return info;
}

std::vector<Sample> hand_motion(std::size_t count, std::uint64_t seed) {
  constexpr double kPeriod = 1e-3;
  constexpr double kQuantum = 1e-5;
  constexpr std::size_t kPassTicks = 18000;
  RandomStream random(seed, "hand motion");
  std::vector<Sample> samples(count);
  Eigen::Vector3d tremor = Eigen::Vector3d::Zero();
  Eigen::Vector3d last = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  double reading = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    Sample& sample = samples[i];
    const double t = kPeriod * static_cast<double>(i);
    const double run = kPeriod * static_cast<double>(i % kPassTicks);
    for (Eigen::Index a = 0; a < 3; ++a) {
      tremor[a] += -0.02 * tremor[a] + 1e-5 * random.normal();
    }
    const Eigen::Vector3d ideal(-0.05 + 0.0056 * run, 0.02 * std::sin(0.9 * run + 0.1 * t),
                                0.01 * std::sin(1.7 * run));
    const Eigen::Vector3d hand = ideal + tremor;
    for (Eigen::Index a = 0; a < 3; ++a) {
      sample.position[a] = kQuantum * std::nearbyint(hand[a] / kQuantum);
    }
    if (i > 0) {
      velocity += 0.1 * ((sample.position - last) / kPeriod - velocity);
    }
    last = sample.position;
    sample.velocity = velocity;
    sample.target_force = 1.5 + 0.6 * std::sin(1.1 * run) + 0.3 * std::sin(0.7 * run + 1.0);
    reading += 0.05 * (random.normal() * 0.05 - reading);
    sample.applied_force = sample.target_force + reading;
    sample.force = 200.0 * (ideal - sample.position) - 2.0 * velocity;
    sample.force.z() += sample.applied_force;
    sample.sequence = i;
    sample.time_ns = static_cast<std::int64_t>(i) * 1000000;
    sample.pass = static_cast<std::int32_t>(i / kPassTicks);
    sample.stage = i % kPassTicks < 1000 ? Stage::kApproach : Stage::kRun;
    sample.saturated = random.uniform() < 0.001;
  }
  return samples;
}

Sample on_file(const Sample& sample) {
  const auto grid = [](double value, double resolution) {
    return static_cast<double>(static_cast<float>(std::nearbyint(value / resolution) * resolution));
  };
  Sample out = sample;
  for (Eigen::Index a = 0; a < 3; ++a) {
    out.position[a] = grid(sample.position[a], std::ldexp(1.0, -20));
    out.velocity[a] = grid(sample.velocity[a], std::ldexp(1.0, -16));
    out.force[a] = grid(sample.force[a], std::ldexp(1.0, -13));
  }
  out.applied_force = grid(sample.applied_force, std::ldexp(1.0, -13));
  out.target_force = grid(sample.target_force, std::ldexp(1.0, -13));
  return out;
}

bool same(const Sample& a, const Sample& b) {
  return a.sequence == b.sequence && a.time_ns == b.time_ns && a.position == b.position &&
         a.velocity == b.velocity && a.force == b.force && a.applied_force == b.applied_force &&
         a.target_force == b.target_force && a.pass == b.pass && a.stage == b.stage &&
         a.saturated == b.saturated;
}

record::TableList drilling_and_common() {
  record::TableList tables = record::drilling_tables();
  const record::TableList& common = record::common_tables();
  tables.insert(tables.end(), common.begin(), common.end());
  return tables;
}

record::BoneRecord small_bone() {
  record::BoneRecord record;
  record.bone = {0, "Röhre", "made by hand", {3, 4, 2}, {0.1, -0.2, 0.3}, 5e-4};
  record.structures = {{0, 1, "bone", {0.9, 0.8, 0.7}, 1.0, false},
                       {0, 7, "nerve", {1.0, 1.0, 0.0}, 0.5, true}};
  record.runs = {{0, 1, 2, 1}, {0, 2 + 3 * (3 + 4 * 1), 1, 7}};
  record.densities = {{0, 2, 0.25F}};
  return record;
}

std::vector<record::ToolRow> tool_motion(std::size_t count, std::uint64_t seed) {
  RandomStream random(seed, "tool motion");
  std::vector<record::ToolRow> rows(count);
  for (std::size_t i = 0; i < count; ++i) {
    record::ToolRow& row = rows[i];
    row.sequence = i;
    row.orientation =
        Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal())
            .normalized();
    row.buttons = static_cast<std::uint32_t>(random.below(1u << 31));
    row.keys = static_cast<std::uint32_t>(random.below(2048));
    row.pedal = random.uniform();
    row.tool = static_cast<std::int32_t>(random.below(5));
    row.mode = static_cast<std::uint8_t>(random.below(4));
    row.active = random.below(2) == 1;
    row.power = random.below(2) == 1;
    row.piece = static_cast<std::int32_t>(random.below(65)) - 1;
    row.immersed = static_cast<std::int32_t>(random.below(11500));
    row.removed = random.uniform();
    row.contact = {random.normal(), random.normal(), random.normal()};
  }
  return rows;
}

}  // namespace haptrial::test
