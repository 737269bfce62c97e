#include "core/stream/stream_rows.h"

#include <algorithm>

namespace haptrial::stream {

void StreamRows::add(const record::Rows& rows) {
  if (outlet_ == nullptr) {
    return;
  }
  const std::size_t channels = stream_.channels.size();
  stream_.read(rows, [&](const SideSample& sample) {
    waiting_.push_back({sample.sequence, sample.after});
    const auto values = sample.values.first(std::min(sample.values.size(), channels));
    values_.insert(values_.end(), values.begin(), values.end());
    values_.resize(waiting_.size() * channels, 0.0);
  });
}

void StreamRows::follow(std::span<const record::Sample> samples) {
  if (waiting_.empty() || samples.empty()) {
    return;
  }
  const auto channels = static_cast<std::ptrdiff_t>(stream_.channels.size());
  sent_.clear();
  times_.clear();
  std::ptrdiff_t done = 0;
  auto sample = samples.begin();
  for (const Waiting& row : waiting_) {
    while (sample != samples.end() && sample->sequence < row.sequence) {
      ++sample;
    }
    if (sample == samples.end()) {
      break;
    }
    const auto values = values_.begin() + done++ * channels;
    if (sample->sequence != row.sequence) {
      continue;  // its tick was lost
    }
    times_.push_back(1e-9 * static_cast<double>(sample->time_ns) + row.after);
    sent_.insert(sent_.end(), values, values + channels);
  }
  waiting_.erase(waiting_.begin(), waiting_.begin() + done);
  values_.erase(values_.begin(), values_.begin() + done * channels);
  outlet_->push_side(number_, sent_, times_);
}

}  // namespace haptrial::stream
