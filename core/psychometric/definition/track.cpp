#include "core/psychometric/definition/track.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace haptrial::psychometric {

namespace {

double rounded_within(double asked, double low, double high, double resolution) noexcept {
  const double kept = std::clamp(asked, low, high);
  if (resolution <= 0.0) {
    return kept;
  }
  const double rounded = std::round(kept / resolution) * resolution;
  return rounded < low    ? std::ceil(low / resolution) * resolution
         : rounded > high ? std::floor(high / resolution) * resolution
                          : rounded;
}

}  // namespace

bool has_multiple(double low, double high, double resolution) noexcept {
  constexpr double kSlack = 1e-9;  // 0.3 is a multiple of 0.1
  return resolution <= 0.0 ||
         std::floor(high / resolution + kSlack) >= std::ceil(low / resolution - kSlack);
}

std::optional<double> Track::smallest_change() const noexcept {
  std::optional<double> smallest;
  for (const double step : steps) {
    const double up = std::abs(axis.level(axis.at(low) + step) - low);
    const double down = std::abs(high - axis.level(axis.at(high) - step));
    smallest = std::min({smallest.value_or(up), up, down});
  }
  return smallest;
}

std::string Track::lesson() const {
  switch (learns_from) {
    case OutcomeForm::kMagnitude:
      return "a number above 0";
    case OutcomeForm::kAdjustment:
      return "1, -1 or 0";
    case OutcomeForm::kAnswer:
      break;
  }
  return outcomes == 2 ? "0 or 1" : fmt::format("a whole number from 0 to {}", outcomes - 1);
}

bool Track::learns(double outcome) const noexcept {
  const bool whole = outcome == std::floor(outcome);
  switch (learns_from) {
    case OutcomeForm::kMagnitude:
      return std::isfinite(outcome) && outcome > 0.0;
    case OutcomeForm::kAdjustment:
      return whole && std::abs(outcome) <= 1.0;
    case OutcomeForm::kAnswer:
      break;
  }
  return whole && outcome >= 0.0 && outcome < static_cast<double>(outcomes);
}

double Track::applied(double asked) const noexcept {
  return rounded_within(asked, low, high, resolution);
}

Level Track::applied(const Level& asked) const {
  Level level{applied(asked.front())};
  for (std::size_t i = 0; i < further.size(); ++i) {
    const TrackDimension& own = further[i];
    level.push_back(rounded_within(asked[i + 1], own.low, own.high, own.resolution));
  }
  return level;
}

std::vector<std::string> Track::variables() const {
  std::vector<std::string> names{variable};
  for (const TrackDimension& each : further) {
    names.push_back(each.variable);
  }
  return names;
}

bool Track::sets(const std::string& one) const {
  const std::vector<std::string> names = variables();
  return std::ranges::find(names, one) != names.end();
}

Level Track::corner(bool of_high) const {
  Level level{of_high ? high : low};
  for (const TrackDimension& each : further) {
    level.push_back(of_high ? each.high : each.low);
  }
  return applied(level);
}

}  // namespace haptrial::psychometric
