#include "experiments/runner/stream_markers.h"

#include <fmt/format.h>

#include "experiments/control/live_status.h"

namespace haptrial::experiments {

std::string marker_fields(const record::PassRow& row) {
  return fmt::format("trial={} practice={} attempt={} block={} repetition={} condition={}",
                     row.trial, row.practice ? 1 : 0, row.attempt, row.block, row.repetition,
                     row.condition);
}

void StreamMarkers::mark(const char* kind, const record::PassRow& row,
                         const std::string& more) const {
  outlet_->mark(fmt::format("{}: pass={} phase={} {}{}", kind, pass_, record::name_of(row.phase),
                            more.empty() ? "" : more + " ", marker_fields(row)),
                time_ns_);
}

void StreamMarkers::follow(std::span<const record::Sample> samples, const record::PassRow& row) {
  if (outlet_ == nullptr) {
    return;
  }
  for (const record::Sample& sample : samples) {
    if (sample.pass < 0) {
      continue;
    }
    time_ns_ = sample.time_ns;
    if (sample.pass != pass_) {
      pass_ = sample.pass;
      stage_ = record::Stage::kIdle;
      mark("pass_begin", row, "");
    }
    if (sample.stage != stage_) {
      stage_ = sample.stage;
      mark("stage", row, fmt::format("stage={}", name_of(stage_)));
    }
  }
}

void StreamMarkers::end_pass(const record::PassRow& row) {
  if (outlet_ != nullptr && pass_ >= 0) {
    const bool completed = row.status == record::PassStatus::kCompleted;
    mark("pass_end", row, fmt::format("status={}", completed ? "completed" : "aborted"));
    pass_ = -1;
  }
}

}  // namespace haptrial::experiments
