#include "experiments/runner/loop_watch.h"

#include <fmt/format.h>

#include "core/record/read/overruns.h"

namespace haptrial::experiments {

void LoopWatch::begin_pass(std::uint64_t ticks, std::uint64_t overruns) {
  begin_ = {{}, ticks, overruns};
  moments_.clear();
}

std::optional<std::string> LoopWatch::overloaded(Time now, std::uint64_t ticks,
                                                 std::uint64_t overruns) {
  constexpr std::chrono::seconds kWindow{1};
  constexpr double kShare = 0.2;
  moments_.push_back({now, ticks, overruns});
  while (moments_.size() > 2 && now - moments_[1].time >= kWindow) {
    moments_.pop_front();
  }
  const Moment& first = moments_.front();
  const double seconds = std::chrono::duration<double>(now - first.time).count();
  if (now - first.time < kWindow) {
    return std::nullopt;
  }
  const auto made = static_cast<double>(ticks - first.ticks);
  const auto late = static_cast<double>(overruns - first.overruns);
  if (made >= (1.0 - kShare) * rate_hz_ * seconds || late <= kShare * made) {
    return std::nullopt;
  }
  return fmt::format(
      "the servo loop is overloaded: {:.0f} of {:.0f} ticks a second, {:.0f} % of "
      "them overran their period",
      made / seconds, rate_hz_, 100.0 * late / made);
}

std::optional<std::string> LoopWatch::end_pass(std::uint64_t ticks, std::uint64_t overruns) const {
  return record::too_many_overruns(ticks - begin_.ticks, overruns - begin_.overruns);
}

}  // namespace haptrial::experiments
