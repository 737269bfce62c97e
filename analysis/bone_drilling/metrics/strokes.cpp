#include "analysis/bone_drilling/metrics/strokes.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace haptrial::analysis::drilling {
namespace {

/// Ticks of drilling without a lift, both inclusive.
struct Run {
  std::size_t first, last;
};

bool drills(const Procedure& p, const ToolTick& tick) {
  return tick.drills() && p.burr_radius(tick.tool) > 0.0;
}

std::vector<Run> runs_of(const Procedure& p, double lift) {
  const auto longest = static_cast<std::uint64_t>(std::llround(lift * p.rate)) + 1;
  std::vector<Run> runs;
  for (std::size_t i = 0; i < p.ticks.size(); ++i) {
    if (!drills(p, p.ticks[i])) {
      continue;
    }
    const bool goes_on = !runs.empty() &&
                         p.ticks[i].sequence - p.ticks[runs.back().last].sequence <= longest &&
                         p.ticks[i].tool == p.ticks[runs.back().last].tool;
    if (goes_on) {
      runs.back().last = i;
    } else {
      runs.push_back({i, i});
    }
  }
  return runs;
}

/// Path and jerk of ticks from the means over steps of whole ticks.
class Motion {
 public:
  Motion(const Procedure& procedure, double step)
      : ticks_(procedure.ticks),
        rate_(procedure.rate),
        step_(std::max<std::ptrdiff_t>(std::llround(step * procedure.rate), 1)) {}

  double length(std::size_t first, std::size_t last) const {
    double sum = 0.0;
    for (std::size_t at = first; at < last;) {
      const std::size_t next = std::min(at + static_cast<std::size_t>(step_), last);
      sum += (ticks_[next].position - ticks_[at].position).norm();
      at = next;
    }
    return sum;
  }

  std::optional<double> smoothness(std::size_t first, std::size_t last) const {
    const auto begin = static_cast<std::ptrdiff_t>(first);
    const std::ptrdiff_t steps = (static_cast<std::ptrdiff_t>(last) - begin) / step_;
    if (steps < 5) {
      return std::nullopt;
    }
    const double h = static_cast<double>(step_) / rate_;
    double squares = 0.0;
    double peak = 0.0;
    for (std::ptrdiff_t i = 0; i < steps; ++i) {
      const std::ptrdiff_t at = begin + i * step_;
      const Eigen::Vector3d v = velocity(at);
      const Eigen::Vector3d jerk =
          (velocity(at + step_) - 2.0 * v + velocity(at - step_)) / (h * h);
      squares += jerk.squaredNorm() * h;
      peak = std::max(peak, v.norm());
    }
    if (!(peak > 0.0) || !(squares > 0.0)) {
      return std::nullopt;
    }
    const double duration = h * static_cast<double>(steps);
    return -std::log(std::pow(duration, 3) / (peak * peak) * squares);
  }

 private:
  /// The mean over a step from tick `at` on; before the first and after the last tick the tip
  /// moves on as there.
  Eigen::Vector3d velocity(std::ptrdiff_t at) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::ptrdiff_t i = at; i < at + step_; ++i) {
      const auto last = static_cast<std::ptrdiff_t>(ticks_.size()) - 1;
      sum += ticks_[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, last))].velocity;
    }
    return sum / static_cast<double>(step_);
  }

  const std::vector<ToolTick>& ticks_;
  double rate_;
  std::ptrdiff_t step_;  // [ticks]
};

void check(const StrokeParameters& p) {
  if (!(p.turn_back > 0.0 && p.lift >= 0.0 && p.shortest >= 0.0 && p.step > 0.0)) {
    throw std::invalid_argument(
        "StrokeParameters: turn_back and step must be above 0, lift and shortest not below");
  }
}

}  // namespace

std::vector<Stroke> find_strokes(const Procedure& procedure, const StrokeParameters& parameters) {
  check(parameters);
  const Motion motion(procedure, parameters.step);
  std::vector<Stroke> strokes;
  const auto add = [&](std::size_t first, std::size_t last, double extent) {
    if (last > first && extent >= parameters.shortest) {
      Stroke stroke;
      stroke.first = first;
      stroke.last = last;
      stroke.duration = static_cast<double>(last - first) / procedure.rate;
      stroke.length = motion.length(first, last);
      stroke.speed = stroke.length / stroke.duration;
      stroke.smoothness = motion.smoothness(first, last);
      strokes.push_back(stroke);
    }
  };
  for (const Run& run : runs_of(procedure, parameters.lift)) {
    std::size_t start = run.first;
    std::size_t farthest = start;
    double extent = 0.0;  // from the start to the farthest
    for (std::size_t i = start + 1; i <= run.last; ++i) {
      const double away = (procedure.ticks[i].position - procedure.ticks[start].position).norm();
      if (away > extent) {
        extent = away;
        farthest = i;
      } else if (extent - away > parameters.turn_back) {
        add(start, farthest, extent);
        start = farthest;
        i = farthest;
        extent = 0.0;
      }
    }
    add(start, run.last, extent);
  }
  return strokes;
}

StrokeFigures stroke_figures(const Procedure& procedure, const StrokeParameters& parameters) {
  const std::vector<Stroke> strokes = find_strokes(procedure, parameters);
  StrokeFigures figures;
  figures.count = strokes.size();
  const auto drilling = static_cast<double>(
      std::count_if(procedure.ticks.begin(), procedure.ticks.end(),
                    [&](const ToolTick& tick) { return drills(procedure, tick); }));
  if (drilling > 0.0) {
    figures.rate = static_cast<double>(strokes.size()) * procedure.rate / drilling;
  }
  if (strokes.empty()) {
    return figures;
  }
  const auto mean = [&](auto&& value) {
    double sum = 0.0;
    std::size_t count = 0;
    for (const Stroke& stroke : strokes) {
      if (const std::optional<double> v = value(stroke)) {
        sum += *v;
        ++count;
      }
    }
    return count > 0 ? std::optional(sum / static_cast<double>(count)) : std::nullopt;
  };
  figures.length = mean([](const Stroke& s) { return std::optional(s.length); });
  figures.speed = mean([](const Stroke& s) { return std::optional(s.speed); });
  figures.duration = mean([](const Stroke& s) { return std::optional(s.duration); });
  figures.smoothness = mean([](const Stroke& s) { return s.smoothness; });
  return figures;
}

}  // namespace haptrial::analysis::drilling
