#include "analysis/power/power_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace haptrial::analysis {

std::string share_words(const TestCount& count) {
  if (count.made == 0) {
    return "not made";
  }
  const Share share = share_of(count.rejected, count.made);
  return fmt::format("{:.3f} ({:.3f} to {:.3f})", share.value, share.low, share.high);
}

std::string level_words(Level level) {
  switch (level) {
    case Level::kKept:
      return "compatible with its level";
    case Level::kAbove:
      return "rejects too often";
    case Level::kBelow:
      return "rejects too seldom";
    case Level::kUnknown:
      break;
  }
  return "not known";
}

namespace {

/// "95 of 2000 and 105 of 2000 studies".
std::string null_counts(const PowerResult& result) {
  std::string words;
  for (std::size_t i = 0; i < result.nulls.size(); ++i) {
    const TestCount count = result.nulls[i].counts.of(result.watch);
    words += fmt::format("{}{} of {}",
                         i == 0                        ? ""
                         : i + 1 < result.nulls.size() ? ", "
                                                       : " and ",
                         count.rejected, count.made);
  }
  return words + " studies";
}

}  // namespace

std::string verdict(const PowerResult& result) {
  const Level level = level_of(result, result.watch);
  if (level == Level::kKept) {
    return fmt::format("Without an effect the test \"{}\" rejects in {}, compatible with {}.",
                       result.watch, null_counts(result), result.alpha);
  }
  if (level == Level::kUnknown) {
    return fmt::format(
        "Nothing without an effect was simulated, or the test \"{}\" could not be made there, so "
        "its true level is not known and no share below is a power.",
        result.watch);
  }
  double rate = 0.0;
  for (const PowerCell& cell : result.nulls) {
    const TestCount count = cell.counts.of(result.watch);
    rate = std::max(rate, static_cast<double>(count.rejected) / static_cast<double>(count.made));
  }
  const std::string found = fmt::format(
      "Without any effect the test \"{}\" rejects in {:.1f} % of studies where {:g} % "
      "are allowed: it ",
      result.watch, 100.0 * rate, 100.0 * result.alpha);
  return level == Level::kBelow
             ? found + "is cautious, and the shares below are its power."
             : found +
                   "finds effects that are not there. Shares of rejections below are "
                   "therefore not called power.";
}

std::string mean_words(const RunningMean& mean) {
  return mean.count == 0 ? "-" : fmt::format("{:.4g} ± {:.2g}", mean.mean, mean.error());
}

std::vector<PowerLine> lines_over(const PowerResult& result, std::size_t key) {
  std::map<std::vector<double>, PowerLine> lines;
  for (const PowerCell& cell : result.cells) {
    std::vector<double> others = cell.levels;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(key));
    PowerLine& line = lines[others];
    line.cells.push_back(&cell);
    line.name.clear();
    for (std::size_t i = 0; i < result.keys.size(); ++i) {
      if (i != key) {
        line.name += fmt::format("{}{} {}", line.name.empty() ? "" : ", ", result.keys[i].name,
                                 cell.levels[i]);
      }
    }
  }
  std::vector<PowerLine> all;
  for (auto& [others, line] : lines) {
    std::ranges::sort(line.cells, {}, [&](const PowerCell* cell) { return cell->levels[key]; });
    for (const PowerCell* cell : line.cells) {
      line.x.push_back(cell->levels[key]);
    }
    all.push_back(std::move(line));
  }
  return all;
}

/// Says how long so many participants are in the lab, as ", 12.5 hours of sessions".
static std::string hours_words(const PowerLine& line, const std::optional<double>& participants) {
  const double each = line.cells.back()->counts.hours.mean / line.x.back();
  return participants && each > 0.0
             ? fmt::format(", {:.1f} hours of sessions", each * std::ceil(*participants - 1e-9))
             : "";
}

std::vector<std::string> size_lines(const PowerResult& result) {
  std::vector<std::string> lines;
  if (!result.participants() || !is_power(result)) {
    return lines;
  }
  for (const PowerLine& line : lines_over(result, *result.participants())) {
    std::vector<PowerPoint> points;
    for (const PowerCell* cell : line.cells) {
      const TestCount count = cell->counts.of(result.watch);
      if (count.made > 0) {
        points.push_back({cell->levels[*result.participants()], count});
      }
    }
    if (points.empty()) {
      continue;
    }
    const SmallestN size = smallest_n(points, result.target);
    const auto word = [&](const std::optional<double>& n) {
      return !n                       ? fmt::format("more than {:g}", points.back().n)
             : *n <= points.front().n ? fmt::format("{:g} or fewer", points.front().n)
                                      : fmt::format("{:.0f}", std::ceil(*n - 1e-9));
    };
    lines.push_back(fmt::format(
        "{}{}a power of {:g} takes {} participants (95 % Monte Carlo interval {} to {}){}",
        line.name, line.name.empty() ? "" : ": ", result.target, word(size.n), word(size.low),
        word(size.high), hours_words(line, size.n)));
  }
  if (!lines.empty()) {
    lines.emplace_back(
        "the intervals are those of the simulation alone; they say nothing of the effect and the "
        "variances that were assumed");
  }
  return lines;
}

}  // namespace haptrial::analysis
