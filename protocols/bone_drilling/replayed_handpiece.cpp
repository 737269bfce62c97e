#include "protocols/bone_drilling/replayed_handpiece.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/record/read/tick_rows.h"
#include "core/record/table/schema.h"

namespace haptrial::protocols {
namespace {

/// A tick on which the hand waited for the bone has such rows.
bool waited(const record::ToolRow& tool, const record::HandpieceRow& held) {
  return tool.tool == 0 && !tool.power && tool.contact.isZero(0.0) && !held.reversed &&
         held.sharpness == 1.0 && held.shaft.isZero(0.0);
}

}  // namespace

device::DeviceReading reading_of(const record::Sample& sample, const record::ToolRow& tool) {
  device::DeviceReading reading;
  reading.tool = {sample.position, sample.velocity};
  reading.orientation = tool.orientation;
  reading.buttons = tool.buttons;
  reading.keys = tool.keys;
  reading.pedal = tool.pedal;
  return reading;
}

std::string difference(std::uint64_t sequence, const char* part, const Eigen::Vector3d& recorded,
                       const Eigen::Vector3d& force) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (record::on_grid(force[axis], record::kForceResolution) != recorded[axis]) {
      return fmt::format(
          "on tick {} the record has ({}, {}, {}) N on {}, and the simulation ({}, {}, {})",
          sequence, recorded[0], recorded[1], recorded[2], part, force[0], force[1], force[2]);
    }
  }
  return "";
}

std::string difference(const record::HandpieceRow& recorded, const bone::Simulator& simulator,
                       const Eigen::Vector3d& shaft) {
  const bone::SimulatorOutput& out = simulator.output();
  const bone::Handpiece& held = simulator.handpiece();
  if (held.reversed() != recorded.reversed || held.sharpness(out.tool) != recorded.sharpness) {
    return fmt::format(
        "on tick {} the record has a burr of sharpness {}, reversed {}, and the simulation {}, {}",
        recorded.sequence, recorded.sharpness, recorded.reversed, held.sharpness(out.tool),
        held.reversed());
  }
  const std::string of_burr =
      difference(recorded.sequence, "the burr's shaft", recorded.shaft, shaft);
  return !of_burr.empty() ? of_burr
                          : difference(recorded.sequence, "the tube's shaft", recorded.tube_shaft,
                                       out.tube.shaft);
}

ReplayedHandpiece::ReplayedHandpiece(const record::SessionReader& reader,
                                     const DrillingInput& input, const bone::Simulator& simulator)
    : reader_(reader), input_(input), simulator_(simulator), touch_(simulator) {}

void ReplayedHandpiece::read(std::uint64_t at) {
  constexpr std::uint64_t kPiece = 65536;  // rows read at once
  const std::uint64_t count = std::min(kPiece, reader_.sample_count() - at);
  samples_ = reader_.samples(at, count);
  tool_ = reader_.rows<record::ToolRow>(at, count);
  held_ = reader_.rows<record::HandpieceRow>(at, count);
}

std::string ReplayedHandpiece::check(std::uint64_t sequence) {
  const auto is_read = [&] {
    return !samples_.empty() && samples_.front().sequence <= sequence &&
           sequence <= samples_.back().sequence;
  };
  if (!is_read()) {
    read(record::row_of_tick(reader_, record::samples_table(), sequence));
  }
  const auto i = static_cast<std::size_t>(
      std::ranges::lower_bound(samples_, sequence, {}, &record::Sample::sequence) -
      samples_.begin());
  if (i >= held_.size() || samples_[i].sequence != sequence || !tool_[i].active ||
      waited(tool_[i], held_[i])) {
    return "";
  }
  const bone::SimulatorInput own = input_.of(reading_of(samples_[i], tool_[i]), 0.0);
  return difference(held_[i], simulator_, touch_.tick(simulator_, own.tool).shaft);
}

}  // namespace haptrial::protocols
