#include "analysis/quality/run_quality.h"

#include <algorithm>
#include <cmath>

namespace haptrial::analysis {
namespace {

using record::Sample;

constexpr double kSwing = 2.0;         // between two turns: far above tremor and noise [N]
constexpr double kFastSwing = 0.0501;  // from turn to turn, half a period of 10 Hz [s]

double seconds(std::int64_t ns) { return 1e-9 * static_cast<double>(ns); }

/// How long a force swung fast, and how often.
struct FastSwings {
  double time{0.0};  // [s]
  int swings{0};
};

/// @param force  of a sample [N]
template <class Force>
FastSwings fast_swings(std::span<const Sample> run, const Force& force) {
  FastSwings found;
  std::size_t high = 0;
  std::size_t low = 0;
  int direction = 0;
  std::optional<std::size_t> last_turn;
  const auto turn = [&](std::size_t at) {
    if (direction == 0) {
      return;  // where the curve begins, it does not turn
    }
    const double time = last_turn ? seconds(run[at].time_ns - run[*last_turn].time_ns) : 1.0;
    if (time <= kFastSwing) {
      found.time += time;
      ++found.swings;
    }
    last_turn = at;
  };
  for (std::size_t k = 0; k < run.size(); ++k) {
    const double f = force(run[k]);
    high = f > force(run[high]) ? k : high;
    low = f < force(run[low]) ? k : low;
    if (direction >= 0 && force(run[high]) - f >= kSwing) {
      turn(high);
      direction = -1;
      high = low = k;
    } else if (direction <= 0 && f - force(run[low]) >= kSwing) {
      turn(low);
      direction = 1;
      high = low = k;
    }
  }
  return found;
}

/// Adds the oscillation along the axis on which it was worst.
void add_oscillation(RunQuality& quality, std::span<const Sample> run) {
  const FastSwings axes[] = {fast_swings(run, [](const Sample& s) { return s.applied_force; }),
                             fast_swings(run, [](const Sample& s) { return s.force.x(); }),
                             fast_swings(run, [](const Sample& s) { return s.force.z(); })};
  const FastSwings& worst =
      *std::max_element(std::begin(axes), std::end(axes),
                        [](const auto& a, const auto& b) { return a.time < b.time; });
  quality.oscillation = std::min(1.0, worst.time / *quality.duration);
  if (worst.swings > 0) {
    quality.oscillation_frequency = 0.5 * worst.swings / worst.time;
  }
}

void add_ticks(RunQuality& quality, std::span<const Sample> run, double rate) {
  std::size_t late = 0;
  double fastest = 0.0;
  for (std::size_t k = 1; k < run.size(); ++k) {
    const double period = seconds(run[k].time_ns - run[k - 1].time_ns);
    late += period * rate > 1.5 ? 1 : 0;
    if (period > 0.0) {
      fastest = std::max(fastest, (run[k].position - run[k - 1].position).norm() / period);
    }
  }
  const auto periods = static_cast<double>(run.size() - 1);
  quality.late_ticks = static_cast<double>(late) / periods;
  quality.missing_ticks =
      std::max(0.0, 1.0 - periods / std::max(1.0, std::round(*quality.duration * rate)));
  quality.top_speed = fastest;
}

}  // namespace

RunQuality run_quality(std::span<const Sample> run, double rate) {
  RunQuality quality;
  if (run.size() < 2 || run.back().time_ns <= run.front().time_ns) {
    return quality;
  }
  quality.duration = seconds(run.back().time_ns - run.front().time_ns);
  double target = run.front().target_force;
  double peak = 0.0;
  std::size_t saturated = 0;
  for (const Sample& s : run) {
    target = std::max(target, s.target_force);
    peak = std::max(peak, std::abs(s.applied_force));
    saturated += s.saturated ? 1 : 0;
  }
  quality.target_peak = target;
  quality.peak_force = peak;
  quality.saturation = static_cast<double>(saturated) / static_cast<double>(run.size());
  add_oscillation(quality, run);
  add_ticks(quality, run, rate);
  return quality;
}

std::optional<double> dropped_frames(std::span<const record::FrameRow> frames, std::int64_t begin,
                                     std::int64_t end) {
  const auto first = std::lower_bound(
      frames.begin(), frames.end(), begin,
      [](const record::FrameRow& frame, std::int64_t time) { return frame.time_ns < time; });
  std::int64_t shown = 0;
  std::int64_t dropped = 0;
  for (auto frame = first; frame != frames.end() && frame->time_ns <= end; ++frame) {
    ++shown;
    dropped += std::max(0, frame->dropped);
  }
  if (shown == 0) {
    return std::nullopt;
  }
  return static_cast<double>(dropped) / static_cast<double>(shown + dropped);
}

}  // namespace haptrial::analysis
