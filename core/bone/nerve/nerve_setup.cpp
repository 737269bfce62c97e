#include "core/bone/nerve/nerve_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/definition/table.h"
#include "core/bone/nerve/threshold_search.h"

namespace haptrial::nerve {
namespace {

constexpr double kLeastRate = 8000.0;  // of electromyograms [Hz]
constexpr double kHighest = 400e-6;    // to which a threshold may rise [V]
constexpr double kMetresPerMm = 1e-3;
constexpr const char* kPoints =
    "two points or more, such as [[10.0, 4.5, 2.0], [12.0, 5.0, 2.5]] [mm]";

/// The muscles of a nerve: what the table names, or one that is called like the nerve.
std::vector<std::string> read_channels(Table& table, const std::string& nerve) {
  std::vector<std::string> channels;
  if (table.has("channels")) {
    channels = table.texts("channels");
    if (channels.empty()) {
      table.reject("channels", "is empty; name a muscle, or leave the key out");
    }
  } else {
    table.otherwise("channels", "one, named like the nerve");
  }
  if (channels.empty()) {
    channels.push_back(nerve);
  }
  return channels;
}

std::vector<Eigen::Vector3d> read_points(Table& table) {
  std::vector<Eigen::Vector3d> points;
  bool good = true;
  for (const auto& row : table.rows("points_mm", kPoints)) {
    good = good && row.size() == 3;
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < row.size() && i < 3; ++i) {
      good = good && row[i].number.has_value() && std::isfinite(row[i].number.value_or(0.0));
      point[static_cast<Eigen::Index>(i)] = kMetresPerMm * row[i].number.value_or(0.0);
    }
    points.push_back(point);
  }
  if (!good || points.size() < 2) {
    table.reject("points_mm", good ? fmt::format("a list of {}", points.size()) : "something else",
                 kPoints);
    points.assign(2, Eigen::Vector3d::Zero());
  }
  return points;
}

WatchedNerve read_curve(Table& table) {
  WatchedNerve nerve;
  nerve.name = table.text("name");
  nerve.curve = read_points(table);
  nerve.radius = kMetresPerMm * table.number_or("radius_mm", 0.5, {0.0, 5.0, true}, "mm");
  nerve.channels = read_channels(table, nerve.name);
  return nerve;
}

std::vector<WatchedNerve> read_nerves(Table& table) {
  std::vector<WatchedNerve> nerves;
  if (table.has("nerves") || !table.has("curves")) {
    for (Table& each : table.tables("nerves")) {
      WatchedNerve nerve;
      nerve.name = each.text("structure");
      nerve.channels = read_channels(each, nerve.name);
      nerves.push_back(std::move(nerve));
    }
  }
  if (table.has("curves")) {
    for (Table& each : table.tables("curves")) {
      nerves.push_back(read_curve(each));
    }
  }
  return nerves;
}

void check_nerves(Table& table, const NerveSetup& setup) {
  const char* key = table.has("nerves") ? "nerves" : "curves";
  std::vector<std::string> nerves, channels;
  for (const WatchedNerve& nerve : setup.nerves) {
    nerves.push_back(nerve.name);
    channels.insert(channels.end(), nerve.channels.begin(), nerve.channels.end());
  }
  const auto twice = [&](std::vector<std::string>& names, const char* what) {
    std::sort(names.begin(), names.end());
    const auto at = std::adjacent_find(names.begin(), names.end());
    if (at != names.end()) {
      table.reject(key, fmt::format("has two {} named \"{}\"; give each its own name", what, *at));
    }
  };
  if (channels.size() > kMostChannels) {
    table.reject(key, fmt::format("has {} channels in all; name at most {}", channels.size(),
                                  kMostChannels));
  }
  twice(nerves, "nerves");
  twice(channels, "channels");
}

}  // namespace

std::size_t NerveSetup::channels() const noexcept {
  std::size_t count = 0;
  for (const WatchedNerve& nerve : nerves) {
    count += nerve.channels.size();
  }
  return count;
}

std::size_t samples_a_tick(double rate) noexcept {
  return static_cast<std::size_t>(std::max(1.0, std::ceil(kLeastRate / rate - 1e-9)));
}

NerveSetup read_nerve_setup(Table& table, double rate) {
  NerveSetup s;
  s.nerves = read_nerves(table);
  check_nerves(table, s);
  MonitorParameters& m = s.monitor;
  m.threshold = table.number_or("threshold", m.threshold, {10e-6, kHighest}, "V");
  m.highest = table.number_or("highest_threshold", m.highest, {10e-6, kHighest}, "V");
  if (m.highest < m.threshold) {
    table.reject(table.has("highest_threshold") ? "highest_threshold" : "threshold",
                 "makes highest_threshold lower than threshold; make it at least as high");
  }
  m.rises_after = table.number_or("rises_after", m.rises_after, {1.0, 600.0}, "s");
  m.returns_after = table.number_or("returns_after", m.returns_after, {1.0, 600.0}, "s");
  m.artefact_filter =
      table.has("artefact_filter") ? table.boolean("artefact_filter") : m.artefact_filter;
  s.muted = table.has("muted") && table.boolean("muted");
  s.current = table.number_or("stimulus", s.current, {kLeastStimulus, kMostStimulus}, "A");
  s.pulses = table.number_or("stimuli", s.pulses, {0.5, 5.0}, "1/s");
  s.heard = read_given_in(table, "heard_in");
  ExposureParameters& e = s.exposure;
  e.bursts = table.number_or("bursts", e.bursts, {0.0, 100.0}, "1/s");
  e.reach = table.number_or("reach", e.reach, {1e-4, 0.02}, "m");
  s.heat = table.number_or("heat", s.heat, {0.0, 100.0}, "W/N");
  if (samples_a_tick(rate) > kMostSamples) {
    table.reject("nerves", fmt::format("needs at least {:.0f} ticks a second; raise "
                                       "experiment.rate, which is {:g} Hz",
                                       kLeastRate / kMostSamples, rate));
  }
  const double samples = rate * static_cast<double>(samples_a_tick(rate));
  m.rate = s.emg.rate = samples;
  return s;
}

}  // namespace haptrial::nerve
