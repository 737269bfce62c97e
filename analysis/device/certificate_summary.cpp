#include "analysis/device/certificate_summary.h"

#include <fmt/format.h>

#include <cctype>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>

#include "analysis/device/part_words.h"

namespace haptrial::analysis {

Finding finding(const char* name, const std::string& title, const Interval& interval,
                const char* unit) {
  return {.name = name,
          .title = title,
          .value = interval.value,
          .low = interval.low,
          .high = interval.high,
          .unit = unit};
}

Finding missing(const char* name, const std::string& title, const char* unit, std::string why) {
  return {.name = name, .title = title, .unit = unit, .why_not = std::move(why)};
}

namespace {

/// A title with the part's words: {force}, {place}, {newtons} and {wall}, in small letters.
std::string title_of(const PartWords& words, const char* pattern) {
  std::string force = words.force, place = words.place;
  force[0] = static_cast<char>(std::tolower(force[0]));
  place[0] = static_cast<char>(std::tolower(place[0]));
  std::string title =
      fmt::format(fmt::runtime(pattern), fmt::arg("force", force), fmt::arg("place", place),
                  fmt::arg("newtons", words.newtons), fmt::arg("wall", words.wall));
  title[0] = static_cast<char>(std::toupper(title[0]));
  return title;
}

/// Mean over the driven axes of a part of each; nothing if one of them lacks it.
template <class Axis, class Part>
std::optional<Interval> mean_over(const std::vector<Axis>& axes, Part part) {
  std::vector<Interval> all;
  for (const Axis& axis : axes) {
    const std::optional<Interval> one = std::invoke(part, axis);
    if (!one) {
      return std::nullopt;
    }
    all.push_back(*one);
  }
  return all.empty() ? std::nullopt : std::optional(mean_of(all));
}

std::optional<WeighedMotion> weighed(const CertificateRecord& record,
                                     const CertificateResult& result) {
  if (result.free.empty() || result.loaded.size() != result.free.size()) {
    return std::nullopt;
  }
  std::vector<Interval> gains, inertias;
  for (std::size_t axis = 0; axis < result.free.size(); ++axis) {
    const WeighedMotion one = weigh(result.free[axis], result.loaded[axis], record.mass);
    gains.push_back(one.gain);
    inertias.push_back(one.inertia);
  }
  return WeighedMotion{mean_of(gains), mean_of(inertias)};
}

void add_static(const CertificateRecord& record, const CertificateResult& result, FindingRow& row) {
  const PartWords& words = words_of(record.of);
  const auto weights = weighed(record, result);
  const std::string gain = title_of(words, "{force} given per {force} commanded");
  const std::string zone = title_of(words, "Dead zone: commands up to here give no {force}");
  const auto free_zone =
      mean_over(result.free, [](const FreeMotion& a) { return std::optional(a.dead_zone); });
  if (result.statics) {
    row.push_back(finding("gain", gain, result.statics->gain, ""));
    row.push_back(finding("dead_zone", zone, result.statics->dead_zone, "N"));
    return;
  }
  row.push_back(weights ? finding("gain", gain, weights->gain, "")
                        : missing("gain", gain, "", words.needs_either));
  row.push_back(free_zone ? finding("dead_zone", zone, *free_zone, "N")
                          : missing("dead_zone", zone, "N", words.needs_sensor));
}

/// A tip's weight hangs along y; about and between other axes, what is left has no such cause.
void add_offset(const CertificateRecord& record, const CertificateResult& result, FindingRow& row) {
  const PartWords& words = words_of(record.of);
  if (record.of == device::Part::kTip) {
    const char* title = "Upward force that is left of the handle's weight";
    row.push_back(result.motion.size() == 3
                      ? finding("gravity_error", title, result.motion[1].offset, "N")
                      : missing("gravity_error", title, "N", words.needs_sensor));
    return;
  }
  const std::string title = title_of(words, "{force} that is left when none is commanded");
  if (result.motion.empty()) {
    row.push_back(missing("gravity_error", title, "N", words.needs_sensor));
  }
  for (std::size_t axis = 0; axis < result.motion.size(); ++axis) {
    const char* along[] = {"gravity_error_x", "gravity_error_y", "gravity_error_z"};
    const bool only = result.motion.size() == 1;
    row.push_back(finding(only ? "gravity_error" : along[record.axes[axis]],
                          only ? title : fmt::format("{}, {}", title, "xyz"[record.axes[axis]]),
                          result.motion[axis].offset, "N"));
  }
}

void add_motion(const CertificateRecord& record, const CertificateResult& result, FindingRow& row) {
  const PartWords& words = words_of(record.of);
  const auto weights = weighed(record, result);
  const auto part = [&](const char* name, const std::string& title, const char* unit, auto of,
                        const char* why) {
    const auto mean = mean_over(result.motion, of);
    row.push_back(mean ? finding(name, title, *mean, unit) : missing(name, title, unit, why));
  };
  part(
      "friction", "Friction", "N", [](const AxisMotion& a) { return std::optional(a.friction); },
      words.needs_sensor);
  const auto free_friction =
      mean_over(result.free, [](const FreeMotion& a) { return std::optional(a.friction); });
  if (free_friction) {
    row.push_back(finding("friction_commanded",
                          title_of(words, "Friction, in {newtons} of the command"), *free_friction,
                          "N"));
  }
  const char* why_no_cogging =
      result.motion.empty() ? words.needs_sensor : "none was found on every axis";
  part(
      "cogging", "Cogging, amplitude", "N", [](const AxisMotion& a) { return a.cogging; },
      why_no_cogging);
  const char* period = "Cogging, way from one to the next";
  if (const auto free_cogging = mean_over(result.free, &FreeMotion::cogging); free_cogging) {
    row.push_back(finding("cogging_commanded",
                          title_of(words, "Cogging, amplitude, in {newtons} of the command"),
                          *free_cogging, "N"));
  }
  if (const auto free_period = mean_over(result.free, &FreeMotion::period);
      result.motion.empty() && free_period) {
    row.push_back(finding("cogging_period", period, *free_period, "m"));
  } else {
    part(
        "cogging_period", period, "m", [](const AxisMotion& a) { return a.period; },
        why_no_cogging);
  }
  part(
      "force_noise", title_of(words, "Ripple of the {force} over the way, root mean square"), "N",
      [](const AxisMotion& a) -> std::optional<Interval> {
        if (!a.cogging) {
          return std::nullopt;
        }
        const double s = std::numbers::sqrt2 / 2.0;
        return Interval{s * a.cogging->value, s * a.cogging->low, s * a.cogging->high,
                        a.cogging->df};
      },
      why_no_cogging);
  if (result.motion.empty() && weights) {
    row.push_back(finding("inertia", "Apparent inertia", weights->inertia, "kg"));
  } else {
    part(
        "inertia", "Apparent inertia", "kg",
        [](const AxisMotion& a) { return std::optional(a.inertia); }, words.needs_either);
  }
  add_offset(record, result, row);
}

/// Figures of the response to forces, from the free handle's motion if no sensor measured it.
void add_response(const CertificateRecord& record, const CertificateResult& result,
                  FindingRow& row) {
  const PartWords& words = words_of(record.of);
  const auto part = [&](const char* name, const std::string& title, const char* unit,
                        auto of_response, auto of_motion, const char* otherwise) {
    const bool measured = !result.response.empty();
    const auto mean =
        measured ? mean_over(result.response, of_response) : mean_over(result.free, of_motion);
    const char* why = measured              ? otherwise
                      : result.free.empty() ? words.needs_sensor
                                            : "motion shows no resonance clearly";
    row.push_back(mean ? finding(name, title, *mean, unit) : missing(name, title, unit, why));
  };
  part(
      "delay", title_of(words, "Delay from a command to its {force}"), "s",
      [](const AxisResponse& a) { return std::optional(a.delay); },
      [](const FreeMotion& a) { return std::optional(a.delay); }, words.needs_sensor);
  part("bandwidth", title_of(words, "Bandwidth of {force} (-3 dB)"), "Hz", &AxisResponse::bandwidth,
       &FreeMotion::bandwidth, "it lies above the highest frequency that was tried");
  part("resonance", "Resonance", "Hz", &AxisResponse::resonance, &FreeMotion::resonance,
       "the response shows none");
  part("damping", "Resonance, share of critical damping", "", &AxisResponse::damping,
       &FreeMotion::damping, "the response shows no resonance");
}

void add_rest(const CertificateRecord& record, const CertificateResult& result, FindingRow& row) {
  const PartWords& words = words_of(record.of);
  const RestNoise& rest = result.rest;
  if (rest.resolution > 0.0) {
    row.push_back({.name = "position_resolution",
                   .title = title_of(words, "Resolution of the {place} (exact)"),
                   .value = rest.resolution,
                   .unit = "m"});
  } else {
    row.push_back(missing("position_resolution", title_of(words, "Resolution of the {place}"), "m",
                          "readings have no smallest step that was seen"));
  }
  row.push_back(finding("position_noise",
                        title_of(words, "Noise of the {place} at rest, standard deviation"),
                        rest.position, "m"));
  row.push_back(finding("velocity_noise", "Noise of the velocity at rest, standard deviation",
                        rest.velocity, "m/s"));
  row.push_back(rest.sensor
                    ? finding("sensor_noise",
                              title_of(words, "Noise of the {force} sensor, standard deviation"),
                              *rest.sensor, "N")
                    : missing("sensor_noise", title_of(words, "Noise of the {force} sensor"), "N",
                              words.needs_sensor));
  if (record.stated_noise > 0.0) {
    row.push_back({.name = "sensor_noise_stated",
                   .title = title_of(words, "Noise of the {force} sensor, as it states"),
                   .value = record.stated_noise,
                   .unit = "N"});
  }
  const std::string wall =
      title_of(words, "Stiffest {wall} that stayed passive, and the softest that did not");
  if (!result.wall || result.wall->passive == 0.0) {
    row.push_back(missing("stiffest_wall", wall, "N/m",
                          !result.wall       ? "it was not tried"
                          : result.wall->met ? "none of those that were tried"
                                             : "the handle did not come to the wall by itself"));
  } else {
    const double above = result.wall->active;
    row.push_back({.name = "stiffest_wall",
                   .title = wall,
                   .value = result.wall->passive,
                   .low = result.wall->passive,
                   .high = above > 0.0 ? above : std::numeric_limits<double>::infinity(),
                   .unit = "N/m"});
  }
}

}  // namespace

FindingList certificate_summary(const CertificateRecord& record, const CertificateResult& result) {
  FindingList list{.name = "summary", .heading = words_of(record.of).heading};
  add_static(record, result, list.findings);
  add_motion(record, result, list.findings);
  add_response(record, result, list.findings);
  add_rest(record, result, list.findings);
  return list;
}

}  // namespace haptrial::analysis
