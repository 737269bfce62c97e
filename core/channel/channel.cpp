#include "core/channel/channel.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/exception_words.h"
#include "core/base/utf8.h"

namespace haptrial::channel {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kLook{20};  // for the end of the session, and for silence
constexpr milliseconds kUntilBegin{1};
constexpr milliseconds kRetry{500};            // until a lost instrument is opened again
constexpr double kSilence = 2.0;               // until a silent one is [s]
constexpr int kMostSteps = 5;                  // of a clock, each soon after the one before
constexpr std::int64_t kSoon = 3'000'000'000;  // after a step of a clock [ns]
constexpr std::size_t kBlock = 256;            // samples in a block of the log
constexpr double kKept = 4.0;                  // for which the log has room [s]
constexpr double kUnseen = 0.5;                // that the servo thread may be late [s]
constexpr std::size_t kLeastBlocks = 16;
constexpr std::size_t kUnseenBlocks = 4;
constexpr std::size_t kMostIncidents = 10000;  // that wait for the session

/// A message of an instrument, as a column of the session file can hold it.
std::string readable(std::string text) {
  const bool known = is_utf8(text);
  std::ranges::replace_if(
      text, [known](char byte) { return byte == '\0' || (!known && (byte & 0x80) != 0); }, '?');
  return text;
}

/// The time of a sample that was stamped `latency` after its measurement.
SampleTime stamped(SampleTime time, const ClockOptions& options) {
  time.time_ns -= std::llround(1e9 * options.latency);
  time.uncertainty = std::hypot(time.uncertainty, options.latency_uncertainty);
  return time;
}

std::size_t blocks_of(double samples, std::size_t least) {
  return std::max(least, static_cast<std::size_t>(samples) / kBlock + 1);
}

}  // namespace

Channel::Channel(ChannelOptions options, Now now, std::uint64_t first)
    : options_(std::move(options)),
      now_(std::move(now)),
      log_(kBlock, blocks_of(kKept * options_.plan.rate, kLeastBlocks)),
      unseen_(kBlock, blocks_of(kUnseen * options_.plan.rate, kUnseenBlocks)),
      clock_(options_.plan.clock),
      next_(first) {
  state_.values.fill(std::numeric_limits<double>::quiet_NaN());
  newest_ = seen_ = state_;
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

std::string Channel::wait_until_open() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return tried_; });
  return error_;
}

const ChannelState& Channel::newest() noexcept {
  latest_.read(newest_);
  return newest_;
}

ChannelState Channel::seen() const {
  const std::lock_guard lock(mutex_);
  return seen_;
}

std::vector<IncidentRow> Channel::take_incidents() {
  const std::lock_guard lock(mutex_);
  return std::exchange(incidents_, {});
}

/// A long text fills several rows.
void Channel::note(Incident what, double amount, const std::string& text,
                   std::optional<std::int64_t> time_ns) {
  const std::int64_t time = time_ns ? *time_ns : now_();
  std::string rest = readable(text);
  const std::lock_guard lock(mutex_);
  do {
    const std::size_t size = whole_characters(rest, record::kTextBytes);
    if (incidents_.size() < kMostIncidents) {
      incidents_.push_back({time, options_.name, what, amount, rest.substr(0, size)});
    }
    rest.erase(0, size);
  } while (!rest.empty());
}

void Channel::show(bool live) {
  state_.live = live;
  state_.lost = !live;
  latest_.write(state_);
  const std::lock_guard lock(mutex_);
  seen_ = state_;
}

void Channel::take(const InstrumentSample& sample) {
  ChannelRow row;
  row.received_ns = now_();
  arrived_ns_ = row.received_ns;
  if (is_useful(sample.values)) {
    heard_ns_ = row.received_ns;
    heard_ = true;
  }
  if (!reading_.load(std::memory_order_relaxed)) {
    return;
  }
  const bool timed = std::isfinite(sample.device_time) && steps_ < kMostSteps;
  const SampleTime time = sample.time ? stamped(*sample.time, options_.plan.clock)
                          : timed     ? clocked(sample, row.received_ns)
                                  : std::as_const(clock_).time_of(row.received_ns, sample.waited);
  if (sample.lost > 0) {
    note(Incident::kGap, static_cast<double>(sample.lost));
    next_ += sample.lost;
  }
  row.sample = next_++;
  row.time_ns = time.time_ns;
  row.uncertainty = time.uncertainty;
  row.device_time = sample.device_time;
  row.values.fill(std::numeric_limits<double>::quiet_NaN());
  std::copy_n(sample.values.begin(), std::min(sample.values.size(), row.values.size()),
              row.values.begin());
  compare_with_limit(row.values);
  std::ranges::replace_if(
      row.values, [](double value) { return std::isinf(value); },
      std::numeric_limits<double>::quiet_NaN());
  if (!log_.push(row)) {
    ++no_room_;
  } else if (no_room_ > 0) {
    note(Incident::kDropped, static_cast<double>(std::exchange(no_room_, 0)));
  }
  unseen_.push(row);
  state_.values = row.values;
  state_.time_ns = row.time_ns;
  show(heard_ || lost_ns_ < 0);
}

/// The time by the instrument's clock. A clock that steps again and again tells no time: one that
/// runs too fast steps with every sample, one that runs too slow about twice a second.
SampleTime Channel::clocked(const InstrumentSample& sample, std::int64_t received_ns) {
  const SampleTime time = clock_.time_of(sample.device_time, received_ns, sample.waited);
  if (time.step == 0.0) {
    steps_ = received_ns - stepped_ns_ > kSoon ? 0 : steps_;
    return time;
  }
  stepped_ns_ = received_ns;
  note(Incident::kClockStep, time.step,
       ++steps_ < kMostSteps
           ? ""
           : "it steps again and again, so that times are those of arrival; is its unit right?");
  return time;
}

/// A limit cannot judge a value that is no number, and a session that needs the channel has nothing
/// from a sample without any.
bool Channel::is_useful(std::span<const double> values) const {
  const auto is_number = [](double value) { return std::isfinite(value); };
  return options_.limit      ? std::ranges::all_of(values, is_number)
         : options_.required ? std::ranges::any_of(values, is_number)
                             : true;
}

/// The servo thread sees only the newest of samples that come together.
void Channel::compare_with_limit(std::span<const double> values) {
  const auto beyond = std::ranges::find_if(
      values, [this](double value) { return options_.limit && std::abs(value) > *options_.limit; });
  if (beyond != values.end()) {
    ++state_.beyond;
    state_.beyond_value = static_cast<std::size_t>(beyond - values.begin());
  }
}

void Channel::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    if (source_ == nullptr && !open()) {
      for (milliseconds waited{0}; waited < kRetry && !stop.stop_requested(); waited += kLook) {
        std::this_thread::sleep_for(kLook);
      }
    } else if (reading_.load(std::memory_order_relaxed) || !source_->keeps_samples()) {
      read();
    } else {
      heard_ns_ = arrived_ns_ = now_();
      std::this_thread::sleep_for(kUntilBegin);
    }
  }
  source_.reset();
}

bool Channel::open() {
  std::string why;
  try {
    source_ = options_.plan.open();
    clock_.restart();
    steps_ = 0;
    heard_ns_ = arrived_ns_ = now_();
  } catch (const std::exception& error) {
    why = sentence_of(error);
  }
  const bool first = [&] {
    const std::lock_guard lock(mutex_);
    error_ = why;
    return !std::exchange(tried_, true);
  }();
  if (source_ != nullptr && first) {
    note(Incident::kOpened, options_.plan.rate);
  } else if (source_ == nullptr && first) {
    lost_ns_ = now_();
    note(Incident::kLost, 0.0, why);
  }
  if (source_ != nullptr && source_->may_be_silent()) {
    come_back();
    show(true);
  }
  changed_.notify_all();
  return source_ != nullptr;
}

void Channel::read() {
  heard_ = false;
  try {
    source_->read(*this, kLook);
  } catch (const std::exception& error) {
    lose(sentence_of(error));
    source_.reset();
    return;
  }
  if (heard_) {
    come_back();
  } else if (!source_->may_be_silent() && time_since(heard_ns_) > options_.plan.patience) {
    const double silence = time_since(arrived_ns_);
    lose(silence > options_.plan.patience ? "no data come any more"
                                          : "its values are no numbers any more");
    if (source_->is_reopened_when_silent() &&
        silence > std::max(kSilence, options_.plan.patience)) {
      source_.reset();
    }
  }
}

double Channel::time_since(std::int64_t time_ns) const {
  return 1e-9 * static_cast<double>(now_() - time_ns);
}

void Channel::come_back() {
  if (lost_ns_ >= 0) {
    note(Incident::kBack, 1e-9 * static_cast<double>(now_() - std::exchange(lost_ns_, -1)));
  }
}

void Channel::lose(const std::string& why) {
  show(false);
  if (lost_ns_ < 0) {
    lost_ns_ = now_();
    note(Incident::kLost, 0.0, why);
  }
}

}  // namespace haptrial::channel
