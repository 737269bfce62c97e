#include "core/bone/nerve/stimulator.h"

#include <algorithm>
#include <cmath>

namespace haptrial::nerve {

void ThresholdSearch::tell(bool answered) noexcept {
  constexpr double kClose = 1.05;
  if (done_) {
    return;
  }
  const int pulse = told_++;
  if (pulse == 0 && !answered) {
    done_ = out_of_range_ = true;  // not even the strongest
    return;
  }
  if (pulse == 0) {
    next_ = low_;
    return;
  }
  if (pulse == 1 && answered) {
    high_ = low_;
    done_ = out_of_range_ = true;
    return;
  }
  (answered ? high_ : low_) = next_;
  next_ = std::sqrt(low_ * high_);
  done_ = high_ <= kClose * low_;
}

namespace {

using StimulusKind = record::NerveStimulusRow::Kind;

constexpr double kEventClosed = 0.16;  // after a pulse its answer is over and is an event [s]

bool same(double a, double b) { return std::abs(a - b) < 1e-6 * std::max(a, b); }

}  // namespace

void Stimulator::give(double current) noexcept {
  current_->store(static_cast<float>(std::clamp(current, kLeastStimulus, kMostStimulus)),
                  std::memory_order_relaxed);
}

void Stimulator::set(double current) noexcept {
  channel_.reset();
  search_.reset();
  give(current);
  set_ = true;
}

void Stimulator::search(std::size_t channel) noexcept {
  channel_ = channel;
  search_.emplace();
  pulse_.reset();
  found_.reset();
  give(search_->current());
  set_ = true;
}

void Stimulator::follow(std::uint64_t sequence, double pulse, bool quiet,
                        std::span<const record::NerveEventRow> ended,
                        std::vector<record::NerveStimulusRow>& rows) {
  const std::int32_t channel = channel_ ? static_cast<std::int32_t>(*channel_) : -1;
  if (!begun_ || set_) {
    rows.push_back(
        {sequence, search_ ? StimulusKind::kSearch : StimulusKind::kSet, channel, current()});
    begun_ = true;
    set_ = false;
  }
  if (pulse > 0.0) {
    rows.push_back({sequence, StimulusKind::kPulse, channel, pulse});
  }
  if (!search_) {
    return;
  }
  for (const record::NerveEventRow& e : ended) {
    answered_ = answered_ || (pulse_ && e.channel == channel && e.begin >= *pulse_ &&
                              e.kind == record::NerveEventRow::Kind::kResponse);
  }
  // A pulse that was on its way when the search asked for another one is not of the search.
  if (pulse > 0.0 && quiet && same(pulse, search_->current())) {
    pulse_ = sequence;
    answered_ = false;
  }
  const auto patience = static_cast<std::uint64_t>(kEventClosed * rate_);
  if (pulse_ && sequence >= *pulse_ + patience) {
    conclude(sequence, rows);
  }
}

/// Whether the pulse was answered is known.
void Stimulator::conclude(std::uint64_t sequence, std::vector<record::NerveStimulusRow>& rows) {
  pulse_.reset();
  search_->tell(answered_);
  if (!search_->done()) {
    give(search_->current());
    return;
  }
  found_ = FoundThreshold{*channel_, search_->threshold(), search_->out_of_range()};
  rows.push_back({sequence, found_->out_of_range ? StimulusKind::kOutOfRange : StimulusKind::kFound,
                  static_cast<std::int32_t>(*channel_), found_->current});
  give(found_->current);
  channel_.reset();
  search_.reset();
}

}  // namespace haptrial::nerve
