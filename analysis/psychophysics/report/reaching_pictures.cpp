
#include <algorithm>
#include <map>

#include "analysis/document/palette.h"
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

/// Mean paths to each target.
BlockPaths paths_of(std::string name, const std::vector<const StudyReach*>& reaches) {
  std::vector<TargetPaths> targets;
  BlockPaths paths;
  paths.block = std::move(name);
  for (const StudyReach* reach : reaches) {
    paths.start = reach->way.start;
    add_reach(targets, *reach);
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

/// Reaches that are drawn together.
struct DrawnReaches {
  std::string name;
  std::size_t block{0};
  const char* dash;
  std::vector<const StudyReach*> reaches{};
};

/// First and last cycle of every block, and its catch trials, as far as there are any.
std::vector<DrawnReaches> drawn_reaches(const ReachingResult& reaching) {
  std::map<const StudyReach*, std::size_t> cycle;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> places;
  for (std::size_t i = 0; i < reaching.reaches.size(); ++i) {
    cycle[&reaching.reaches[i]] =
        places[{reaching.persons[i], reaching.block_of[i]}]++ / reaching.plan.cycle;
  }
  std::vector<DrawnReaches> all;
  for (std::size_t b = 0; b < reaching.blocks.size(); ++b) {
    const ReachBlock& block = reaching.blocks[b];
    DrawnReaches first{block.name + " (first cycle)", b, palette::kLong};
    DrawnReaches last{block.name + " (last cycle)", b, palette::kSolid};
    DrawnReaches catches{block.name + " (catch trials)", b, palette::kShort};
    for (std::size_t i = 0; i < reaching.reaches.size(); ++i) {
      const StudyReach& reach = reaching.reaches[i];
      if (reaching.block_of[i] != b || reach.path.empty()) {
        continue;
      }
      if (reach.kind == ReachKind::kCatch) {
        catches.reaches.push_back(&reach);
      } else if (reach.kind == ReachKind::kPlain && cycle[&reach] == 0) {
        first.reaches.push_back(&reach);
      } else if (reach.kind == ReachKind::kPlain && cycle[&reach] + 1 == block.cycles) {
        last.reaches.push_back(&reach);
      }
    }
    for (DrawnReaches* some : {&first, &last, &catches}) {
      if (!some->reaches.empty()) {
        all.push_back(std::move(*some));
      }
    }
  }
  return all;
}

std::vector<BlockPaths> paths_of_blocks(const std::vector<DrawnReaches>& drawn) {
  std::vector<BlockPaths> all;
  for (const DrawnReaches& some : drawn) {
    all.push_back(paths_of(some.name, some.reaches));
  }
  return all;
}

/// A line for each, labelled once a block: at its last cycle, if it has one beside the first.
Figure speeds_of_blocks(const ReachingResult& reaching, const std::vector<DrawnReaches>& drawn,
                        bool simulated) {
  std::vector<DrawnProfile> profiles;
  for (const DrawnReaches& some : drawn) {
    std::vector<std::vector<double>> speeds;
    for (const StudyReach* reach : some.reaches) {
      speeds.push_back(reach->speed);
    }
    const ReachBlock& block = reaching.blocks[some.block];
    const char* labelled = block.cycles > 1 ? palette::kSolid : palette::kLong;
    profiles.push_back(
        {some.dash == labelled ? block.name : "", some.block, some.dash, mean_profile(speeds)});
  }
  Figure figure = speed_figure(profiles, simulated);
  figure.caption +=
      " Dashed: the first cycle of a block; solid: its last one; dotted: its catch trials.";
  return figure;
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
  const std::vector<DrawnReaches> reaches = drawn_reaches(reaching);
  if (!reaches.empty()) {
    figures.push_back(speeds_of_blocks(reaching, reaches, result.simulated()));
  }
  for (Figure& figure : trajectory_figures(paths_of_blocks(reaches), result.simulated())) {
    figure.caption +=
        " Means over participants; paths of those whose field pushes to the right "
        "are mirrored at the straight way.";
    figures.push_back(std::move(figure));
  }
  return figures;
}

}  // namespace haptrial::analysis::trials
