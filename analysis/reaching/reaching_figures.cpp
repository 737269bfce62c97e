#include "analysis/reaching/reaching_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "analysis/document/palette.h"

namespace haptrial::analysis {
namespace {

using namespace palette;

constexpr double kCentimetres = 100.0;

/// Letters, digits and '-' of a name.
std::string file_part(const std::string& text) {
  std::string part;
  for (const char c : text) {
    const auto u = static_cast<unsigned char>(c);
    part += u < 128 && std::isalnum(u) != 0 ? static_cast<char>(std::tolower(u)) : '-';
  }
  return part;
}

/// The smallest square that holds all blocks, with a margin.
struct Frame {
  Range x, z;
};

Frame frame_of(std::span<const BlockPaths> blocks) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Eigen::Array2d low = Eigen::Array2d::Constant(kInfinity), high = -low;
  const auto hold = [&](const Eigen::Vector3d& p) {
    const Eigen::Array2d flat(kCentimetres * p.x(), kCentimetres * p.z());
    low = low.min(flat);
    high = high.max(flat);
  };
  for (const BlockPaths& block : blocks) {
    hold(block.start);
    std::ranges::for_each(block.targets, hold);
    for (const auto& path : block.paths) {
      std::ranges::for_each(path, hold);
    }
  }
  const Eigen::Array2d middle = 0.5 * (low + high);
  const double half = std::max(0.5, 0.55 * (high - low).maxCoeff());
  return {{middle[0] - half, middle[0] + half}, {middle[1] - half, middle[1] + half}};
}

Figure block_figure(const BlockPaths& block, const Frame& frame, bool simulated) {
  Figure figure;
  figure.name = "trajectories-" + file_part(block.block);
  figure.title = fmt::format("Reaches: {}", block.block);
  figure.x_label = "x [cm]";
  figure.y_label = "z [cm]";
  figure.equal_scale = true;
  figure.height = 0.9;
  figure.x_range = frame.x;
  figure.y_range = Range{frame.z.second, frame.z.first};  // z points downwards, as on the screen
  figure.simulated = simulated;
  Series targets{"target", Mark::kPoints, {kOrange, kSolid, 6, 2.0, 2.0}};
  for (const Eigen::Vector3d& target : block.targets) {
    targets.x.push_back(kCentimetres * target.x());
    targets.y.push_back(kCentimetres * target.z());
  }
  Series start{"start", Mark::kPoints, {kBlack, kSolid, 5, 2.0, 1.2}};
  start.x = {kCentimetres * block.start.x()};
  start.y = {kCentimetres * block.start.z()};
  bool labelled = false;
  for (const auto& path : block.paths) {
    Series line{labelled ? "" : "path of the hand", Mark::kLine, {kBlue, kSolid, 0, 2.0}};
    labelled = true;
    for (const Eigen::Vector3d& p : path) {
      line.x.push_back(kCentimetres * p.x());
      line.y.push_back(kCentimetres * p.z());
    }
    figure.series.push_back(std::move(line));
  }
  if (!targets.x.empty()) {
    figure.series.push_back(targets);
  }
  figure.series.push_back(start);
  figure.caption = fmt::format(
      "Paths of the hand in the block {}, from above: x to the right, z towards the participant.",
      block.block);
  figure.alt = fmt::format("{} paths from the start to {} targets.", block.paths.size(),
                           block.targets.size());
  return figure;
}

Look curve_look(std::size_t index) {
  const std::array<Look, 4> looks{
      Look{kBlue, kSolid, 7, 1.5, 0.9}, Look{kOrange, kSolid, 5, 1.5, 0.9},
      Look{kGreen, kSolid, 9, 1.5, 1.1}, Look{kPurple, kSolid, 13, 1.5, 1.1}};
  return looks[index % looks.size()];
}

/// Range of all drawn curves, for the borders of blocks.
struct Extent {
  double low{0.0}, high{0.0};
  double last{1.0};
  void hold(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

Series means_of(const DrawnCurve& curve, const LearningFigure& drawn, const Look& look,
                Extent& extent) {
  Series series{curve.label, Mark::kBars, look};
  for (std::size_t c = 0; c < curve.points.size(); ++c) {
    const CyclePoint& point = curve.points[c];
    if (point.participants == 0) {
      continue;
    }
    const auto& interval = drawn.within ? point.within : point.between;
    series.x.push_back(curve.first_cycle + static_cast<double>(c));
    series.y.push_back(drawn.scale * point.mean);
    const double a = drawn.scale * (interval ? interval->low : point.mean);
    const double b = drawn.scale * (interval ? interval->high : point.mean);
    series.low.push_back(std::min(a, b));
    series.high.push_back(std::max(a, b));
    extent.hold(series.low.back());
    extent.hold(series.high.back());
    extent.last = std::max(extent.last, series.x.back());
  }
  return series;
}

Series fit_of(const DrawnCurve& curve, double scale, const Look& look) {
  constexpr int kSteps = 10;  // points of the line in each cycle
  Series line{"", Mark::kLine, {look.color, kLong, 0, 2.0}};
  const int last = kSteps * (static_cast<int>(curve.points.size()) - 1);
  for (int i = 0; i <= last; ++i) {
    const double cycle = static_cast<double>(i) / kSteps;
    line.x.push_back(curve.first_cycle + cycle);
    line.y.push_back(scale * curve.fit->at(cycle));
  }
  return line;
}

std::string block_names(const std::vector<BlockStart>& blocks) {
  std::string names;
  for (const BlockStart& block : blocks) {
    names += fmt::format("{}{} from cycle {:.0f}", names.empty() ? "" : ", ", block.block,
                         block.first_cycle);
  }
  return names;
}

}  // namespace

std::vector<Eigen::Vector3d> mean_path(std::span<const TimedReach> reaches, std::size_t samples) {
  if (reaches.empty() || samples < 2) {
    throw std::invalid_argument("reaches: at least one, samples: at least 2");
  }
  std::vector<Eigen::Vector3d> path(samples, Eigen::Vector3d::Zero());
  for (const TimedReach& one : reaches) {
    for (std::size_t i = 0; i < samples; ++i) {
      const double part = static_cast<double>(i) / static_cast<double>(samples - 1);
      const auto here =
          value_at(one.reach.time, one.reach.position, (1.0 - part) * one.onset + part * one.end);
      if (!here) {
        throw std::invalid_argument("onset and end must lie inside the recording");
      }
      path[i] += *here / static_cast<double>(reaches.size());
    }
  }
  return path;
}

std::vector<double> speed_profile(const TimedReach& reach) {
  const double end = std::min(reach.onset + kProfileTime, reach.reach.time.back());
  std::vector<double> speeds;
  for (std::size_t i = 0;; ++i) {
    const double time = reach.onset + kProfileStep * static_cast<double>(i);
    if (i > 0 && time > end) {
      return speeds;
    }
    const auto here = value_at(reach.reach.time, reach.reach.velocity, time);
    if (!here) {
      throw std::invalid_argument("the onset must lie inside the recording");
    }
    speeds.push_back(here->norm());
  }
}

std::vector<double> mean_profile(std::span<const std::vector<double>> profiles) {
  if (profiles.empty()) {
    throw std::invalid_argument("profiles: at least one");
  }
  std::vector<double> means;
  for (std::size_t i = 0;; ++i) {
    double sum = 0.0;
    std::size_t count = 0;
    for (const std::vector<double>& each : profiles) {
      if (i < each.size()) {
        sum += each[i];
        ++count;
      }
    }
    if (count == 0 || 2 * count < profiles.size()) {
      return means;
    }
    means.push_back(sum / static_cast<double>(count));
  }
}

Figure speed_figure(std::span<const DrawnProfile> profiles, bool simulated) {
  Figure figure;
  figure.name = "speed-profiles";
  figure.title = "Speed of the hand";
  figure.x_label = "Time since the onset (s)";
  figure.y_label = "Speed (cm/s)";
  figure.simulated = simulated;
  double fastest = 0.0;
  for (const DrawnProfile& profile : profiles) {
    Series line{profile.label, Mark::kLine, curve_look(profile.block)};
    line.look.dash = profile.dash;
    line.look.width = 2.0;
    for (std::size_t i = 0; i < profile.speed.size(); ++i) {
      line.x.push_back(kProfileStep * static_cast<double>(i));
      line.y.push_back(kCentimetres * profile.speed[i]);
    }
    const auto peak = std::ranges::max_element(line.y);
    if (peak != line.y.end()) {
      fastest = std::max(fastest, *peak);
      if (!profile.label.empty()) {
        figure.alt += fmt::format("{}{}: at most {:.1f} cm/s after {:.2f} s.",
                                  figure.alt.empty() ? "" : " ", profile.label, *peak,
                                  line.x[static_cast<std::size_t>(peak - line.y.begin())]);
      }
      figure.series.push_back(std::move(line));
    }
  }
  figure.y_range = Range{0.0, 1.05 * std::max(fastest, 1e-9)};
  figure.caption =
      "Mean speed of the hand from the onset of the reach on, as long as half of the reaches last.";
  return figure;
}

std::vector<Figure> trajectory_figures(std::span<const BlockPaths> blocks, bool simulated) {
  std::vector<Figure> figures;
  if (!blocks.empty()) {
    const Frame frame = frame_of(blocks);
    for (const BlockPaths& block : blocks) {
      figures.push_back(block_figure(block, frame, simulated));
    }
  }
  return figures;
}

Figure learning_figure(const LearningFigure& drawn) {
  Figure figure;
  figure.name = drawn.name;
  figure.title = drawn.title;
  figure.x_label = "Cycle";
  figure.y_label = drawn.metric;
  figure.simulated = drawn.simulated;
  Extent extent;
  std::vector<Series> curves;
  bool fitted = false;
  for (std::size_t i = 0; i < drawn.curves.size(); ++i) {
    const DrawnCurve& curve = drawn.curves[i];
    curves.push_back(means_of(curve, drawn, curve_look(i), extent));
    if (curve.fit && curve.points.size() > 1) {
      curves.push_back(fit_of(curve, drawn.scale, curve_look(i)));
      fitted = true;
    }
  }
  const double margin = 0.05 * std::max(extent.high - extent.low, 1e-9);
  figure.y_range = Range{extent.low - margin, extent.high + margin};
  figure.x_range = Range{0.0, extent.last + 1.0};
  Series borders{"", Mark::kSegments, {kGrey, kShort, 0, 1.2}};
  for (const BlockStart& block : drawn.blocks) {
    borders.x.push_back(block.first_cycle - 0.5);
    borders.x2.push_back(block.first_cycle - 0.5);
    borders.y.push_back(figure.y_range->first);
    borders.y2.push_back(figure.y_range->second);
  }
  const Series zero{"", Mark::kLine, {kPale, kSolid, 0, 1.0}, {0.0, extent.last + 1.0}, {0.0, 0.0}};
  figure.series = {zero};
  if (!borders.x.empty()) {
    figure.series.push_back(borders);
  }
  figure.series.insert(figure.series.end(), curves.begin(), curves.end());
  figure.caption = fmt::format(
      "Means of the participants' cycles with 95 % intervals {} participants{}{}{}.",
      drawn.within ? "within" : "over", fitted ? "; dashed: the exponential of least squares" : "",
      drawn.blocks.empty() ? "" : "; blocks: ", block_names(drawn.blocks));
  figure.alt = fmt::format("{} over cycles.", drawn.title);
  for (const DrawnCurve& curve : drawn.curves) {
    if (!curve.points.empty()) {
      figure.alt += fmt::format(" {}: from {:.3g} to {:.3g}.", curve.label,
                                drawn.scale * curve.points.front().mean,
                                drawn.scale * curve.points.back().mean);
    }
  }
  return figure;
}

}  // namespace haptrial::analysis
