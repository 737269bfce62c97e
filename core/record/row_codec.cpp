#include "core/record/row_codec.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "core/base/utf8.h"
#include "core/record/packed_row.h"
#include "core/record/schema.h"

namespace haptrial::record {
void check_text(std::string_view text, std::size_t bytes, const char* what) {
  if (text.size() > bytes) {
    throw std::invalid_argument(std::string(what) + " '" + std::string(text) + "' has " +
                                std::to_string(text.size()) + " bytes; allowed: at most " +
                                std::to_string(bytes));
  }
  if (text.find('\0') != std::string_view::npos) {
    throw std::invalid_argument(std::string(what) + " holds a NUL byte; remove it");
  }
}

Phase phase_of(std::string_view name) { return Phase(name.substr(0, Phase::kBytes - 1)); }

namespace {

PackedRow read(const BytePlanes& planes, std::size_t at) { return {planes, at}; }

PassRow read_pass_1(PackedRow& row) {
  PassRow pass;
  pass.trial = row.get<std::int32_t>();
  pass.condition = row.get_text(kConditionBytes);
  pass.phase = phase_of(row.get_text(kPhaseBytes));
  pass.block = row.get<std::int32_t>();
  pass.repetition = row.get<std::int32_t>();
  pass.stimulus_seed = row.get<std::uint64_t>();
  pass.first_sample = row.get<std::uint64_t>();
  pass.last_sample = row.get<std::uint64_t>();
  pass.status =
      row.get_text(kStatusBytes) == "completed" ? PassStatus::kCompleted : PassStatus::kAborted;
  return pass;
}

}  // namespace

void put_pass(BytePlanes& planes, std::size_t at, const PassRow& pass) {
  PackedRow row(planes.row_bytes());
  row.put(pass.trial);
  row.put_text(pass.condition, kConditionBytes, "condition");
  row.put_text(name_of(pass.phase), kPhaseBytes, "phase");
  row.put(pass.block);
  row.put(pass.repetition);
  row.put(pass.stimulus_seed);
  row.put(pass.first_sample);
  row.put(pass.last_sample);
  row.put_text(pass.status == PassStatus::kCompleted ? "completed" : "aborted", kStatusBytes,
               "status");
  row.put(static_cast<std::uint8_t>(pass.practice ? 1 : 0));
  row.put(pass.attempt);
  planes.put_row(at, row.bytes());
}

PassRow get_pass(const BytePlanes& planes, std::size_t at) {
  PackedRow row = read(planes, at);
  PassRow pass = read_pass_1(row);
  pass.practice = row.get<std::uint8_t>() != 0;
  pass.attempt = row.get<std::int32_t>();
  return pass;
}

PassRow get_pass_1(const BytePlanes& planes, std::size_t at) {
  PackedRow row = read(planes, at);
  return read_pass_1(row);
}

void put_stimulus(BytePlanes& planes, std::size_t at, const StimulusRow& stimulus) {
  PackedRow row(planes.row_bytes());
  row.put(stimulus.block);
  row.put(stimulus.time);
  for (Eigen::Index a = 0; a < 3; ++a) row.put(stimulus.position[a]);
  row.put(stimulus.force);
  planes.put_row(at, row.bytes());
}

StimulusRow get_stimulus(const BytePlanes& planes, std::size_t at) {
  PackedRow row = read(planes, at);
  StimulusRow stimulus;
  stimulus.block = row.get<std::int32_t>();
  stimulus.time = row.get<double>();
  for (Eigen::Index a = 0; a < 3; ++a) stimulus.position[a] = row.get<double>();
  stimulus.force = row.get<double>();
  return stimulus;
}

void put_timing(BytePlanes& planes, std::size_t at, const TimingRow& timing) {
  PackedRow row(planes.row_bytes());
  row.put(timing.bin_low_ns);
  row.put(timing.bin_high_ns);
  row.put(timing.period_count);
  row.put(timing.lateness_count);
  row.put(timing.compute_count);
  planes.put_row(at, row.bytes());
}

TimingRow get_timing(const BytePlanes& planes, std::size_t at) {
  PackedRow row = read(planes, at);
  TimingRow timing;
  timing.bin_low_ns = row.get<std::int64_t>();
  timing.bin_high_ns = row.get<std::int64_t>();
  timing.period_count = row.get<std::uint64_t>();
  timing.lateness_count = row.get<std::uint64_t>();
  timing.compute_count = row.get<std::uint64_t>();
  return timing;
}

void put_frame(BytePlanes& planes, std::size_t at, const FrameRow& frame) {
  PackedRow row(planes.row_bytes());
  row.put(frame.time_ns);
  row.put(frame.frame_time_ns);
  row.put(frame.dropped);
  planes.put_row(at, row.bytes());
}

FrameRow get_frame(const BytePlanes& planes, std::size_t at) {
  PackedRow row = read(planes, at);
  FrameRow frame;
  frame.time_ns = row.get<std::int64_t>();
  frame.frame_time_ns = row.get<std::int64_t>();
  frame.dropped = row.get<std::int32_t>();
  return frame;
}

std::vector<EventPart> event_parts(const EventRow& event) {
  std::vector<EventPart> parts;
  std::string_view rest = event.text;
  check_text(event.kind, kKindBytes, "event kind");  // before the first part is put anywhere
  check_text(rest, rest.size(), "event text");
  do {
    const std::size_t size = whole_characters(rest, kTextBytes);
    parts.push_back({{event.time_ns, event.kind, std::string(rest.substr(0, size))},
                     static_cast<std::int32_t>(parts.size())});
    rest.remove_prefix(size);
  } while (!rest.empty());
  return parts;
}

void put_event(BytePlanes& planes, std::size_t at, const EventPart& part) {
  PackedRow row(planes.row_bytes());
  row.put(part.row.time_ns);
  row.put_text(part.row.kind, kKindBytes, "event kind");
  row.put_text(part.row.text, kTextBytes, "event text");
  row.put(part.part);
  planes.put_row(at, row.bytes());
}

EventPart get_event(const BytePlanes& planes, std::size_t at) {
  PackedRow row = read(planes, at);
  EventPart part;
  part.row.time_ns = row.get<std::int64_t>();
  part.row.kind = row.get_text(kKindBytes);
  part.row.text = row.get_text(kTextBytes);
  part.part = row.get<std::int32_t>();
  return part;
}

std::vector<EventRow> joined_events(std::vector<EventPart> parts) {
  std::vector<EventRow> events;
  for (EventPart& part : parts) {
    if (part.part > 0 && !events.empty()) {
      events.back().text += part.row.text;
    } else {
      events.push_back(std::move(part.row));
    }
  }
  return events;
}

void put_attribute(BytePlanes& planes, std::size_t at, const EventPart& part) {
  PackedRow row(planes.row_bytes());
  row.put_text(part.row.kind, kKindBytes, "attribute name");
  row.put_text(part.row.text, kTextBytes, "attribute value");
  row.put(part.part);
  planes.put_row(at, row.bytes());
}

EventPart get_attribute(const BytePlanes& planes, std::size_t at) {
  PackedRow row = read(planes, at);
  EventPart part;
  part.row.kind = row.get_text(kKindBytes);
  part.row.text = row.get_text(kTextBytes);
  part.part = row.get<std::int32_t>();
  return part;
}

}  // namespace haptrial::record
