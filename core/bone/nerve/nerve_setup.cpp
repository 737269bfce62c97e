#include "core/bone/nerve/nerve_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/definition/schema.h"
#include "core/bone/nerve/stimulator.h"

namespace haptrial::nerve {
namespace {

constexpr double kLeastRate = 8000.0;  // of electromyograms [Hz]
constexpr double kHighest = 400e-6;    // to which a threshold may rise [V]
constexpr double kMetresPerMm = 1e-3;
constexpr const char* kPoints =
    "two points or more, such as [[10.0, 4.5, 2.0], [12.0, 5.0, 2.5]] [mm]";

void read_channels(Table& table, const std::string& key, WatchedNerve& nerve) {
  nerve.channels = table.texts(key);
  if (nerve.channels.empty()) {
    table.reject(key, "is empty; name a muscle, or leave the key out");
  }
}

/// The muscles of a nerve: what the table names, or one that is called like the nerve.
const Schema<WatchedNerve>& channels_schema() {
  static const auto schema =
      Schema<WatchedNerve>()
          .custom(
              "channels",
              "Muscles that the nerve moves, a channel of the monitor each; all nerves together "
              "have eight at most",
              read_channels)
          .otherwise("one, named like the nerve")
          .derive([](WatchedNerve& nerve) {
            if (nerve.channels.empty()) {
              nerve.channels.push_back(nerve.name);
            }
          });
  return schema;
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

const Schema<WatchedNerve>& curve_schema() {
  static const auto schema =
      Schema<WatchedNerve>()
          .text("name", &WatchedNerve::name, "Name of a nerve that is drawn as a curve")
          .required()
          .custom("points_mm", "Points of the nerve's curve in the bone's frame",
                  [](Table& table, const std::string&, WatchedNerve& nerve) {
                    nerve.curve = read_points(table);
                  })
          .required()
          .custom("radius_mm", "Radius of the nerve around its curve",
                  [](Table& table, const std::string& key, WatchedNerve& nerve) {
                    nerve.radius = kMetresPerMm * table.number(key, {0.0, 5.0, true}, "mm");
                  })
          .otherwise("0.5");
  return schema;
}

const Schema<WatchedNerve>& structure_schema() {
  static const auto schema = Schema<WatchedNerve>()
                                 .text("structure", &WatchedNerve::name,
                                       "Structure of the bone that is watched as a nerve")
                                 .required();
  return schema;
}

std::vector<WatchedNerve> read_nerves(Table& table) {
  std::vector<WatchedNerve> nerves;
  const auto read = [&](const char* key, const Schema<WatchedNerve>& schema) {
    for (Table& each : table.tables(key)) {
      WatchedNerve nerve = schema.read(each);
      channels_schema().read(each, nerve);
      nerves.push_back(std::move(nerve));
    }
  };
  if (table.has("nerves") || !table.has("curves")) {
    read("nerves", structure_schema());
  }
  if (table.has("curves")) {
    read("curves", curve_schema());
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

const Schema<MonitorParameters>& monitor_schema() {
  using M = MonitorParameters;
  static const auto schema =
      Schema<M>()
          .number("threshold", &M::threshold, {10e-6, kHighest}, "V",
                  "Voltage of an electromyogram above which the monitor sounds a tone")
          .number("highest_threshold", &M::highest, {10e-6, kHighest}, "V",
                  "Voltage to which the threshold rises by itself while tones go on")
          .check([](Table& table, M& m) {
            if (m.highest < m.threshold) {
              table.reject(
                  table.has("highest_threshold") ? "highest_threshold" : "threshold",
                  "makes highest_threshold lower than threshold; make it at least as high");
            }
          })
          .number("rises_after", &M::rises_after, {1.0, 600.0}, "s",
                  "Time with a tone after which the threshold rises")
          .number("returns_after", &M::returns_after, {1.0, 600.0}, "s",
                  "Quiet after which a risen threshold is as at first")
          .flag("artefact_filter", &M::artefact_filter,
                "Whether signals that cross the threshold in every channel at once are left out");
  return schema;
}

const Schema<ExposureParameters>& exposure_schema() {
  using E = ExposureParameters;
  static const auto schema =
      Schema<E>()
          .number(
              "bursts", &E::bursts, {0.0, 100.0}, "1/s",
              "Bursts of a muscle in a second while the burr is right beside the nerve, without "
              "force or speed")
          .number("reach", &E::reach, {1e-4, 0.02}, "m",
                  "Distance from a nerve over which the rate of bursts falls to 1/e");
  return schema;
}

const Schema<NerveSetup>& nerve_schema() {
  using S = NerveSetup;
  static const auto schema =
      Schema<S>()
          .check([](Table& table, S& s) {
            s.nerves = read_nerves(table);
            check_nerves(table, s);
          })
          .keys_of(&S::monitor, monitor_schema())
          .flag("muted", &S::muted, "Whether all channels are silent at the beginning")
          .number("stimulus", &S::current, {kLeastStimulus, kMostStimulus}, "A",
                  "Current of a pulse of the probe")
          .number("stimuli", &S::pulses, {0.5, 5.0}, "1/s", "Pulses of the probe in a second")
          .custom("heard_in",
                  "Procedures in which the participant hears the monitor; every other: the first "
                  "participant from the first on, the second from the second on; or the groups "
                  "that alone do so, in every procedure",
                  [](Table& table, const std::string& key, S& s) {
                    s.heard = read_given_in(table, key);
                  })
          .otherwise("all")
          .keys_of(&S::exposure, exposure_schema())
          .number("heat", &S::heat, {0.0, 100.0}, "W/N",
                  "Power that a newton under a turning burr turns into heat");
  return schema;
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
  NerveSetup s = nerve_schema().read(table);
  if (samples_a_tick(rate) > kMostSamples) {
    table.reject("nerves", fmt::format("needs at least {:.0f} ticks a second; raise "
                                       "experiment.rate, which is {:g} Hz",
                                       kLeastRate / kMostSamples, rate));
  }
  const double samples = rate * static_cast<double>(samples_a_tick(rate));
  s.monitor.rate = s.emg.rate = samples;
  return s;
}

}  // namespace haptrial::nerve
