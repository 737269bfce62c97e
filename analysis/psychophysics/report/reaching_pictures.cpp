#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "analysis/psychophysics/report/trials_figures.h"
#include "analysis/psychophysics/report/trials_words.h"
#include "analysis/reaching/reaching_figures.h"

namespace haptrial::analysis::trials {
namespace {

using Path = std::vector<Eigen::Vector3d>;

constexpr double kSameTarget = 1e-6;  // [m]

/// Path turned so that the field pushes to the left.
Path turned_path(const StudyReach& reach) {
  Path path = reach.path;
  if (reach.push > 0.0) {
    return path;
  }
  const WayFrame frame(reach.way.start, reach.way.target);
  for (Eigen::Vector3d& p : path) {
    p -= 2.0 * frame.lateral(p - reach.way.start) * frame.left();
  }
  return path;
}

/// Sums of the paths to one target.
struct TargetPaths {
  Eigen::Vector3d target;
  Path sum;
  std::size_t count{0};
};

void add_reach(std::vector<TargetPaths>& all, const StudyReach& reach) {
  auto at = std::find_if(all.begin(), all.end(), [&](const TargetPaths& each) {
    return (each.target - reach.way.target).norm() < kSameTarget;
  });
  const Path path = turned_path(reach);
  if (at == all.end()) {
    all.push_back({reach.way.target, path, 1});
    return;
  }
  for (std::size_t i = 0; i < path.size(); ++i) {
    at->sum[i] += path[i];
  }
  ++at->count;
}

/// Mean paths of the reaches that `takes` accepts; nothing to draw: no target.
template <class Takes>
BlockPaths paths_of(const ReachingResult& reaching, std::string name, Takes&& takes) {
  std::vector<TargetPaths> targets;
  BlockPaths paths;
  paths.block = std::move(name);
  for (const StudyReach& reach : reaching.reaches) {
    if (!reach.path.empty() && takes(reach)) {
      paths.start = reach.way.start;
      add_reach(targets, reach);
    }
  }
  for (TargetPaths& each : targets) {
    for (Eigen::Vector3d& p : each.sum) {
      p /= static_cast<double>(each.count);
    }
    paths.targets.push_back(each.target);
    paths.paths.push_back(std::move(each.sum));
  }
  return paths;
}

/// First and last cycle of every block, and its catch trials.
std::vector<BlockPaths> paths_of_blocks(const ReachingResult& reaching) {
  std::map<const StudyReach*, std::size_t> cycle;
  std::map<std::pair<std::size_t, std::string>, std::size_t> places;
  for (std::size_t i = 0; i < reaching.reaches.size(); ++i) {
    const StudyReach& reach = reaching.reaches[i];
    cycle[&reach] = places[{reaching.persons[i], reach.block}]++ / reaching.plan.cycle;
  }
  std::vector<BlockPaths> all;
  for (const ReachBlock& block : reaching.blocks) {
    const auto of_cycle = [&](std::size_t number) {
      return [&, number](const StudyReach& reach) {
        return reach.block == block.name && reach.kind == ReachKind::kPlain &&
               cycle[&reach] == number;
      };
    };
    all.push_back(paths_of(reaching, block.name + " (first cycle)", of_cycle(0)));
    if (block.cycles > 1) {
      all.push_back(paths_of(reaching, block.name + " (last cycle)", of_cycle(block.cycles - 1)));
    }
    all.push_back(paths_of(reaching, block.name + " (catch trials)", [&](const StudyReach& reach) {
      return reach.block == block.name && reach.kind == ReachKind::kCatch;
    }));
  }
  std::erase_if(all, [](const BlockPaths& each) { return each.targets.empty(); });
  return all;
}

/// The cycles of a block, as the figure counts them: from 1.
DrawnCurve drawn(const ReachCurve& curve, const ReachBlock& block, std::string label) {
  DrawnCurve made;
  made.label = std::move(label);
  const auto first = curve.points.begin() + static_cast<std::ptrdiff_t>(block.first_cycle);
  made.points.assign(first, first + static_cast<std::ptrdiff_t>(block.cycles));
  made.first_cycle = static_cast<double>(block.first_cycle + 1);
  return made;
}

/// Curve from the first to the last cycle that has a value.
DrawnCurve whole(const ReachCurve& curve, std::string label) {
  const auto has_value = [](const CyclePoint& point) { return point.participants > 0; };
  const auto first = std::find_if(curve.points.begin(), curve.points.end(), has_value);
  const auto end = std::find_if(curve.points.rbegin(), curve.points.rend(), has_value).base();
  DrawnCurve made;
  made.label = std::move(label);
  made.first_cycle = static_cast<double>(first - curve.points.begin() + 1);
  if (first < end) {
    made.points.assign(first, end);
  }
  return made;
}

std::vector<BlockStart> starts_of(const ReachingResult& reaching) {
  std::vector<BlockStart> starts;
  for (const ReachBlock& block : reaching.blocks) {
    starts.push_back({block.name, static_cast<double>(block.first_cycle + 1)});
  }
  return starts;
}

LearningFigure error_figure(const ReachingResult& reaching) {
  LearningFigure figure;
  figure.title = "Perpendicular error";
  figure.metric = reaching.plan.at_150_ms ? "Perpendicular error at 150 ms (mm)"
                                          : "Largest perpendicular error (mm)";
  figure.scale = kMillimetres;
  for (const ReachBlock& block : reaching.blocks) {
    DrawnCurve curve = drawn(reaching.plain, block, block.name);
    if (block.fit) {
      curve.fit = block.fit->fit;
    }
    figure.curves.push_back(std::move(curve));
  }
  if (reaching.catches.reaches > 0) {
    figure.curves.push_back(whole(reaching.catches, "catch trials"));
  }
  return figure;
}

}  // namespace

std::vector<Figure> reaching_pictures(const TrialsResult& result) {
  if (!result.reaching) {
    return {};
  }
  const ReachingResult& reaching = *result.reaching;
  std::vector<Figure> figures;
  std::vector<LearningFigure> curves{error_figure(reaching)};
  if (reaching.clamps.reaches > 0) {
    curves.emplace_back();
    curves.back().name = "force-compensation";
    curves.back().title = "Force compensation in channels";
    curves.back().metric = "Force compensation (1: all of the field)";
    curves.back().curves.push_back(whole(reaching.clamps, "error clamps"));
  }
  for (LearningFigure& curve : curves) {
    curve.blocks = starts_of(reaching);
    curve.simulated = result.simulated();
    figures.push_back(learning_figure(curve));
  }
  for (Figure& figure : trajectory_figures(paths_of_blocks(reaching), result.simulated())) {
    figure.caption +=
        " Means over participants; paths of those whose field pushes to the right "
        "are mirrored at the straight way.";
    figures.push_back(std::move(figure));
  }
  return figures;
}

}  // namespace haptrial::analysis::trials
