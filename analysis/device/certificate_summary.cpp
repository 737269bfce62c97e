#include "analysis/device/certificate_summary.h"

#include <limits>
#include <numbers>
#include <optional>

namespace haptrial::analysis {

Finding finding(const char* name, const char* title, const Interval& interval, const char* unit) {
  return {.name = name,
          .title = title,
          .value = interval.value,
          .low = interval.low,
          .high = interval.high,
          .unit = unit};
}

Finding missing(const char* name, const char* title, const char* unit, std::string why) {
  return {.name = name, .title = title, .unit = unit, .why_not = std::move(why)};
}

namespace {

constexpr const char* kNeedsSensor = "it takes a force sensor on the handle";
constexpr const char* kNeedsEither =
    "it takes a force sensor, or a known mass on the handle (--mass)";
/// Mean over x, y and z of a part of each; nothing if one of them lacks it.
template <class Axis, class Part>
std::optional<Interval> mean_over(const std::vector<Axis>& axes, Part part) {
  std::vector<Interval> all;
  for (const Axis& axis : axes) {
    const std::optional<Interval> one = part(axis);
    if (!one) {
      return std::nullopt;
    }
    all.push_back(*one);
  }
  return all.empty() ? std::nullopt : std::optional(mean_of(all));
}

std::optional<WeighedMotion> weighed(const CertificateRecord& record,
                                     const CertificateResult& result) {
  if (result.free.size() != 3 || result.loaded.size() != 3) {
    return std::nullopt;
  }
  std::vector<Interval> gains, inertias;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const WeighedMotion one = weigh(result.free[axis], result.loaded[axis], record.mass);
    gains.push_back(one.gain);
    inertias.push_back(one.inertia);
  }
  return WeighedMotion{mean_of(gains), mean_of(inertias)};
}

void add_static(const CertificateRecord& record, const CertificateResult& result, FindingRow& row) {
  const auto weights = weighed(record, result);
  const char* gain = "Force given per force commanded";
  const char* zone = "Dead zone: commands up to here give no force";
  const auto free_zone =
      mean_over(result.free, [](const FreeMotion& a) { return std::optional(a.dead_zone); });
  if (result.statics) {
    row.push_back(finding("gain", gain, result.statics->gain, ""));
    row.push_back(finding("dead_zone", zone, result.statics->dead_zone, "N"));
    return;
  }
  row.push_back(weights ? finding("gain", gain, weights->gain, "")
                        : missing("gain", gain, "", kNeedsEither));
  row.push_back(free_zone ? finding("dead_zone", zone, *free_zone, "N")
                          : missing("dead_zone", zone, "N", kNeedsSensor));
}

void add_motion(const CertificateRecord& record, const CertificateResult& result, FindingRow& row) {
  const auto weights = weighed(record, result);
  const auto part = [&](const char* name, const char* title, const char* unit, auto of,
                        const char* why) {
    const auto mean = mean_over(result.motion, of);
    row.push_back(mean ? finding(name, title, *mean, unit) : missing(name, title, unit, why));
  };
  part(
      "friction", "Friction", "N", [](const AxisMotion& a) { return std::optional(a.friction); },
      kNeedsSensor);
  const auto free_friction =
      mean_over(result.free, [](const FreeMotion& a) { return std::optional(a.friction); });
  if (free_friction) {
    row.push_back(
        finding("friction_commanded", "Friction, in newtons of the command", *free_friction, "N"));
  }
  const char* why_no_cogging =
      result.motion.empty() ? kNeedsSensor : "none was found on every axis";
  part(
      "cogging", "Cogging, amplitude", "N", [](const AxisMotion& a) { return a.cogging; },
      why_no_cogging);
  part(
      "cogging_period", "Cogging, way from one to the next", "m",
      [](const AxisMotion& a) { return a.period; }, why_no_cogging);
  part(
      "force_noise", "Ripple of the force over the way, root mean square", "N",
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
        [](const AxisMotion& a) { return std::optional(a.inertia); }, kNeedsEither);
  }
  if (result.motion.size() == 3) {
    row.push_back(finding("gravity_error", "Upward force that is left of the handle's weight",
                          result.motion[1].offset, "N"));
  } else {
    row.push_back(missing("gravity_error", "Upward force that is left of the handle's weight", "N",
                          kNeedsSensor));
  }
}

void add_response(const CertificateResult& result, FindingRow& row) {
  const auto part = [&](const char* name, const char* title, const char* unit, auto of,
                        const char* otherwise) {
    const auto mean = mean_over(result.response, of);
    row.push_back(
        mean ? finding(name, title, *mean, unit)
             : missing(name, title, unit, result.response.empty() ? kNeedsSensor : otherwise));
  };
  const auto free_delay =
      mean_over(result.free, [](const FreeMotion& a) { return std::optional(a.delay); });
  if (result.response.empty() && free_delay) {
    row.push_back(finding("delay", "Delay from a command to its force", *free_delay, "s"));
  } else {
    part(
        "delay", "Delay from a command to its force", "s",
        [](const AxisResponse& a) { return std::optional(a.delay); }, kNeedsSensor);
  }
  part(
      "bandwidth", "Bandwidth of force (-3 dB)", "Hz",
      [](const AxisResponse& a) { return a.bandwidth; },
      "it lies above the highest frequency that was tried");
  part(
      "resonance", "Resonance", "Hz", [](const AxisResponse& a) { return a.resonance; },
      "the response shows none");
  part(
      "damping", "Resonance, share of critical damping", "",
      [](const AxisResponse& a) { return a.damping; }, "the response shows no resonance");
}

void add_rest(const CertificateRecord& record, const CertificateResult& result, FindingRow& row) {
  const RestNoise& rest = result.rest;
  if (rest.resolution > 0.0) {
    row.push_back({.name = "position_resolution",
                   .title = "Resolution of the position (exact)",
                   .value = rest.resolution,
                   .unit = "m"});
  } else {
    row.push_back(missing("position_resolution", "Resolution of the position", "m",
                          "positions have no smallest step that was seen"));
  }
  row.push_back(finding("position_noise", "Noise of the position at rest, standard deviation",
                        rest.position, "m"));
  row.push_back(finding("velocity_noise", "Noise of the velocity at rest, standard deviation",
                        rest.velocity, "m/s"));
  row.push_back(rest.sensor
                    ? finding("sensor_noise", "Noise of the force sensor, standard deviation",
                              *rest.sensor, "N")
                    : missing("sensor_noise", "Noise of the force sensor", "N", kNeedsSensor));
  if (record.stated_noise > 0.0) {
    row.push_back({.name = "sensor_noise_stated",
                   .title = "Noise of the force sensor, as it states",
                   .value = record.stated_noise,
                   .unit = "N"});
  }
  const char* wall = "Stiffest wall that stayed passive, and the softest that did not";
  if (!result.wall || result.wall->passive == 0.0) {
    row.push_back(missing("stiffest_wall", wall, "N/m",
                          result.wall ? "none of those that were tried" : "it was not tried"));
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
  FindingList list{.name = "summary", .heading = "What the device does"};
  add_static(record, result, list.findings);
  add_motion(record, result, list.findings);
  add_response(result, list.findings);
  add_rest(record, result, list.findings);
  return list;
}

}  // namespace haptrial::analysis
