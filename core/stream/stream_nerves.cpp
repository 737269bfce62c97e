#include "core/stream/stream_nerves.h"

namespace haptrial::stream {

void StreamNerves::add(std::span<const record::EmgRow> rows) {
  if (outlet_ != nullptr && channels_ > 0) {
    waiting_.insert(waiting_.end(), rows.begin(), rows.end());
  }
}

void StreamNerves::follow(std::span<const record::Sample> samples) {
  if (waiting_.empty() || samples.empty()) {
    return;
  }
  values_.clear();
  times_.clear();
  std::size_t done = 0;
  auto sample = samples.begin();
  for (const record::EmgRow& row : waiting_) {
    while (sample != samples.end() && sample->sequence < row.sequence) {
      ++sample;
    }
    if (sample == samples.end()) {
      break;
    }
    ++done;
    if (sample->sequence != row.sequence) {
      continue;  // its tick was lost
    }
    const double place = static_cast<double>(row.sample) / rate_;
    times_.push_back(1e-9 * static_cast<double>(sample->time_ns) + place);
    values_.insert(values_.end(), row.channels.begin(),
                   row.channels.begin() + static_cast<std::ptrdiff_t>(channels_));
  }
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(done));
  outlet_->push_nerves(values_, times_);
}

}  // namespace haptrial::stream
