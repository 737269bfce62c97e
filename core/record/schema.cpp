#include "core/record/schema.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "core/record/columns.h"

namespace haptrial::record {
namespace {

using namespace columns;

constexpr std::array kSamples{
    u64("sequence", "tick number from 0; a gap is a loss"),
    i64("time_ns", "ns", "since the first tick of the session"),
    i32("pass", "row of /trials; -1 between passes"),
    u8("stage", "0 idle, 1 approach, 2 wait, 3 run, 4 return"),
    f32("position_x", "m", "tool tip in the world frame", kPositionResolution),
    f32("position_y", "m", "tool tip in the world frame", kPositionResolution),
    f32("position_z", "m", "tool tip in the world frame", kPositionResolution),
    f32("velocity_x", "m/s", "tool tip in the world frame", kVelocityResolution),
    f32("velocity_y", "m/s", "tool tip in the world frame", kVelocityResolution),
    f32("velocity_z", "m/s", "tool tip in the world frame", kVelocityResolution),
    f32("force_x", "N", "commanded to the device, in the world frame", kForceResolution),
    f32("force_y", "N", "commanded to the device, in the world frame", kForceResolution),
    f32("force_z", "N", "commanded to the device, in the world frame", kForceResolution),
    f32("applied_force", "N", "normal force of the participant, downward positive",
        kForceResolution),
    f32("target_force", "N", "normal force to apply", kForceResolution),
    u8("saturated", "1 where the force limit was reached"),
};

constexpr std::array kTrials{
    i32("trial", "trial number from 1; a training pass and a test pass, or a drilling"),
    text("condition", kConditionBytes, "training condition of the block"),
    text("phase", kPhaseBytes, "training, test or drilling"),
    i32("block", "block number from 1; of practice -1, -2, ..., 0 in files of older versions"),
    i32("repetition", "number from 1 within the block; of a drilling the number of its bone"),
    u64("stimulus_seed", "seed of the block's stimulus"),
    u64("first_sample", "sequence number of the first sample, inclusive"),
    u64("last_sample", "sequence number of the last sample, inclusive"),
    text("status", kStatusBytes, "completed or aborted"),
    u8("practice", "1 where the pass is not part of the study"),
    i32("attempt", "number from 1; above 1 the trial was aborted before and queued again"),
};
constexpr std::size_t kNewInTrials = 2;  // columns that schema version 1 does not have

constexpr std::array kEvents{
    i64("time_ns", "ns", "since the first tick of the session"),
    text("kind", kKindBytes, "what happened, in one word"),
    text("text", kTextBytes, "details"),
    i32("part", "0; 1, 2, ... where the row continues the text of the row before"),
};

constexpr std::array kStimuli{
    i32("block", "block number from 1"),
    f64("time", "s", "since the start of the run"),
    f64("position_x", "m", "ideal tool tip in the world frame"),
    f64("position_y", "m", "ideal tool tip in the world frame"),
    f64("position_z", "m", "ideal tool tip in the world frame"),
    f64("force", "N", "target normal force"),
};

constexpr std::array kTiming{
    i64("bin_low_ns", "ns", "lower edge of the bin, inclusive"),
    i64("bin_high_ns", "ns", "upper edge of the bin, exclusive"),
    u64("period_count", "ticks whose time since the tick before lies in the bin"),
    u64("lateness_count", "ticks whose start lagged the schedule by a time in the bin"),
    u64("compute_count", "ticks whose computation took a time in the bin"),
};

constexpr std::array kFrames{
    i64("time_ns", "ns", "when the frame was shown, since the first tick of the session"),
    i64("frame_time_ns", "ns", "what drawing the frame took"),
    i32("dropped", "refreshes of the screen missed since the frame before"),
};

constexpr std::array kAttributes{
    text("name", kKindBytes, "of a root attribute, or of a count of /timing"),
    text("value", kTextBytes, "as text"),
    i32("part", "0; 1, 2, ... where the row continues the value of the row before"),
};

constexpr std::array kRuns{
    i32("run", "number from 1: from one start of the program to its end"),
    u64("first_sample", "sequence number of the first tick of the run"),
    u64("ticks", "ticks of the run so far"),
    u64("overruns", "ticks of the run so far that began after their period had passed"),
    u64("dropped", "records of the run so far that were lost on the way"),
    i32("planned", "trials of the study; -1: not known"),
    text("state", kStatusBytes, "running, stopped (the session goes on in another run) or ended"),
};

constexpr std::array kBegun{
    i32("pass", "row of /trials that the pass gets"),
    i32("trial", "as in /trials, like all that follow"),
    text("condition", kConditionBytes, "training condition of the block"),
    text("phase", kPhaseBytes, "training, test or drilling"),
    i32("block", "block number from 1"),
    i32("repetition", "number from 1 within the block; of a drilling the number of its bone"),
    u64("stimulus_seed", "seed of the block's stimulus"),
    u8("practice", "1 where the pass is not part of the study"),
    i32("attempt", "number from 1; above 1 the trial was aborted before and queued again"),
};

// 270 kB a chunk: within the 1 MiB chunk cache that HDF5 gives every reader.
constexpr std::size_t kSampleChunk = 4096;
constexpr TableSchema kSamplesSchema{"samples", "one row for each tick of the servo loop",
                                     kSampleChunk, kSamples};
constexpr TableSchema kTrialsSchema{"trials", "one row for each pass", 64, kTrials};
constexpr TableSchema kTrialsSchema1{"trials", "one row for each pass", 64,
                                     std::span(kTrials).first(kTrials.size() - kNewInTrials)};
constexpr TableSchema kEventsSchema{"events", "what happened when", 64, kEvents};
constexpr TableSchema kStimuliSchema{"stimuli", "the ideal movement and force of each block", 4096,
                                     kStimuli};
constexpr TableSchema kTimingSchema{"timing", "histogram of how the loop kept time", 256, kTiming};

// 0.8 s at 60 Hz.
constexpr TableSchema kFramesSchema{"frames", "one row for each frame of the participant's screen",
                                    48, kFrames};
constexpr TableSchema kAttributesSchema{
    "attributes", "the root attributes once more: found even where the file's structure is lost",
    512, kAttributes};
constexpr TableSchema kRunsSchema{
    "runs", "what the loop of each run of the session counted: its last row counts", 16, kRuns};
constexpr TableSchema kBegunSchema{"begun", "one row for each pass, written when it begins", 64,
                                   kBegun};

}  // namespace

std::size_t TableSchema::row_bytes() const {
  std::size_t bytes = 0;
  for (const Column& column : columns) bytes += column.bytes;
  return bytes;
}

std::size_t TableSchema::offset(std::string_view column) const {
  std::size_t bytes = 0;
  for (const Column& each : columns) {
    if (column == each.name) return bytes;
    bytes += each.bytes;
  }
  throw std::invalid_argument("no column " + std::string(column) + " in /" + name);
}

const TableSchema& samples_schema() { return kSamplesSchema; }
const TableSchema& trials_schema() { return kTrialsSchema; }
const TableSchema& trials_schema_1() { return kTrialsSchema1; }
const TableSchema& events_schema() { return kEventsSchema; }
const TableSchema& stimuli_schema() { return kStimuliSchema; }
const TableSchema& timing_schema() { return kTimingSchema; }
const TableSchema& frames_schema() { return kFramesSchema; }
const TableSchema& attributes_schema() { return kAttributesSchema; }
const TableSchema& runs_schema() { return kRunsSchema; }
const TableSchema& begun_schema() { return kBegunSchema; }

std::size_t live_chunk_rows(double rate) {
  constexpr double kLongest = 0.8;  // [s]
  const double steps = kLongest * rate / static_cast<double>(kLiveChunkStep);
  const double most = static_cast<double>(kSampleChunk / kLiveChunkStep);
  return kLiveChunkStep * static_cast<std::size_t>(std::clamp(steps, 1.0, most));
}

}  // namespace haptrial::record
