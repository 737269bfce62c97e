#include "experiments/runner/sinks.h"

#include <fmt/format.h>

#include "experiments/control/live_status.h"

namespace haptrial::experiments {

/// An answer survives whatever comes after it.
void FileSink::rows(const record::Rows& rows) {
  if (rows.table == &record::responses_table()) {
    writer_.add_at_once(rows);
  } else if (rows.count > 0) {
    writer_.add(rows);
  }
}

StreamSink::StreamSink(stream::LslOutlet* outlet, const std::vector<stream::SideStream>& sides)
    : outlet_(outlet), markers_(outlet) {
  for (const stream::SideStream& side : sides) {
    sides_.emplace_back(outlet, side, sides_.size());
  }
}

void StreamSink::rows(const record::Rows& rows) {
  for (stream::StreamRows& side : sides_) {
    side.add(rows);
  }
}

void StreamSink::samples(std::span<const record::Sample> samples) {
  if (outlet_ != nullptr) {
    outlet_->push(samples);
  }
  for (stream::StreamRows& side : sides_) {
    side.follow(samples);
  }
  markers_.follow(samples, pass_);
}

void StreamSink::event(const record::EventRow& event) {
  if (outlet_ != nullptr) {
    outlet_->mark(event.kind + (event.text.empty() ? "" : ": " + event.text), event.time_ns);
  }
}

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
    mark("pass_end", row, fmt::format("status={}", record::name_of(row.status)));
    pass_ = -1;
  }
}

}  // namespace haptrial::experiments
