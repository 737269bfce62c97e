#include "experiments/runner/sinks.h"

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

}  // namespace haptrial::experiments
