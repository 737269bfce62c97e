#include "analysis/contact/evaluation/prepare_contact.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "analysis/contact/evaluation/check_body.h"
#include "analysis/contact/evaluation/in_trajectory.h"
#include "analysis/contact/evaluation/surface_lag.h"
#include "analysis/statistics/base/descriptive.h"
#include "core/base/require.h"

namespace haptrial::evaluation {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kMostFitted = 3000;  // contacts that fix a registration: more change nothing
constexpr std::size_t kFewestContacts = 12;
constexpr double kPeriodsOfVelocity = 5.0;    // of poses that a velocity is taken over
constexpr double kLeastVelocityWidth = 0.02;  // [s]
constexpr std::size_t kFewestForLag = 100;    // poses
constexpr int kLagRounds = 6;
constexpr double kSameLag = 2e-4;      // [s]
constexpr double kMuchFriction = 0.6;  // rare between dry solids
constexpr double kInwards = 0.2;       // share of contacts pulled inwards that is doubted
constexpr double kOffBody = 0.05;      // of a size: a median distance that is doubted
constexpr double kFarFromBody = 10.0;  // of the path's size: likewise, however large the body

void check_options(const PrepareOptions& o) {
  require(o.rate >= 10.0 && o.rate <= 1e5, "rate: allowed: 10 to 100000 Hz");
  require(o.radius >= 0.0 && std::isfinite(o.radius), "radius: allowed: 0 or more");
  require(o.least_force > 0.0, "least_force: allowed: above 0");
  require(o.stiffness > 0.0 && std::isfinite(o.stiffness), "stiffness: allowed: above 0");
  require(o.tip.allFinite(), "tip: allowed: finite");
  require(!o.lag || std::isfinite(*o.lag), "lag: allowed: finite");
}

double mean_period(const PoseStream& pose) {
  return (pose.time.back() - pose.time.front()) / static_cast<double>(pose.size() - 1);
}

/// The time over which poses give a velocity [s].
double velocity_width(const PoseStream& path) {
  return std::max(kPeriodsOfVelocity * mean_period(path) * (1.0 + 1e-9), kLeastVelocityWidth);
}

/// The path of the probe's point in W.
PoseStream tip_path(const PoseStream& pose, const Vector3d& tip) {
  PoseStream path = pose;
  for (std::size_t i = 0; i < path.size(); ++i) {
    path.position[i] += path.orientation[i] * tip;
  }
  return path;
}

ContactRecording shifted(ContactRecording recording, double lag) {
  for (double& t : recording.force.time) {
    t -= lag;
  }
  return recording;
}

/// The load, with the forces `lag` earlier than their clock says.
SensorLoad load_at(const ContactRecording& recording, double lag, const PrepareOptions& o,
                   PreparedContact& result) {
  if (o.load || o.free.empty()) {
    return o.load.value_or(SensorLoad{});
  }
  result.load = estimate_load(shifted(recording, lag), o.mount, o.free, o.up);
  return result.load->load;
}

/// Forces on the probe in W, on the poses' clock. The load is found anew at each lag, which turns
/// the weight.
ForceStream forces_at(const ContactRecording& recording, double lag, const PrepareOptions& o,
                      PreparedContact& result) {
  result.lag_used = lag;
  ForceStream forces =
      contact_forces(shifted(recording, lag), o.mount, load_at(recording, lag, o, result));
  for (Vector3d& f : forces.force) {
    f *= o.force_on_body ? -1.0 : 1.0;
  }
  return forces;
}

ForceStream first_forces(const ContactRecording& recording, const PoseStream& path,
                         const PrepareOptions& o, PreparedContact& result) {
  const ForceStream forces = forces_at(recording, o.lag.value_or(0.0), o, result);
  if (o.lag) {
    return forces;
  }
  result.lag = estimate_lag(path, forces);
  return result.lag->doubt.empty() ? forces_at(recording, result.lag->lag, o, result) : forces;
}

void remark_on_load(const PrepareOptions& o, PreparedContact& result) {
  if (result.load && result.load->force_rms > o.least_force) {
    result.remarks.push_back(
        fmt::format("The load leaves {:.2g} N in the stretches that were named as free of contact "
                    "(root mean square): perhaps something is touched there.",
                    result.load->force_rms));
  }
  if (result.load) {
    result.remarks.insert(result.remarks.end(), result.load->unfixed.begin(),
                          result.load->unfixed.end());
  } else if (!o.load) {
    result.remarks.push_back(
        "No stretch without contact was named: the forces are taken as free of weight and offset.");
  }
  if (result.lag && !result.lag->doubt.empty()) {
    result.remarks.push_back(result.lag->doubt + " No lag was removed.");
  }
}

void remark_on_distance(double median, std::span<const Vector3d> contacts,
                        PreparedContact& result) {
  if (median > kOffBody * path_size(contacts)) {
    result.remarks.push_back(
        fmt::format("The path does not lie on the body: half of the contacts are more than {:.2g} "
                    "mm off. The mesh may be another body, in another unit or elsewhere.",
                    1e3 * median));
  }
}

Eigen::Isometry3d body_from_world(const PoseStream& path, const ForceStream& at_poses,
                                  const contact::FeltBody& body, const PrepareOptions& o,
                                  PreparedContact& result) {
  if (o.registered) {
    return Eigen::Isometry3d::Identity();
  }
  std::vector<Vector3d> contacts;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (at_poses.force[i].norm() > o.least_force) {
      contacts.push_back(path.position[i]);
    }
  }
  if (contacts.size() < kFewestContacts) {
    throw std::invalid_argument(
        fmt::format("{} of {} poses are in contact (with a force above {:g} N); a registration "
                    "needs {} or more",
                    contacts.size(), path.size(), o.least_force, kFewestContacts));
  }
  check_size(body, contacts);
  const std::size_t step = (contacts.size() + kMostFitted - 1) / kMostFitted;
  std::vector<Vector3d> fitted;
  for (std::size_t i = 0; i < contacts.size(); i += step) {
    fitted.push_back(contacts[i]);
  }
  RegistrationOptions options = o.registration;
  options.radius = o.radius;
  result.registration = register_path(body.distance, fitted, options);
  result.remarks.insert(result.remarks.end(), result.registration->unfixed.begin(),
                        result.registration->unfixed.end());
  remark_on_distance(result.registration->median, contacts, result);
  return result.registration->body_from_world;
}

/// Contact of samples with the body.
struct Touch {
  std::vector<Vector3d> at, out, normal, force;  // the probe, its contact
  std::vector<double> depth;
  std::vector<bool> touching;
  double inwards{0.0};  // share of the forces above the least one that point into the body
};

Touch touch_body(const PoseStream& path, const ForceStream& force, const Eigen::Isometry3d& T_BW,
                 const contact::FeltBody& body, const contact::Shading& shading,
                 const PrepareOptions& o) {
  Touch t;
  std::vector<contact::SurfacePoint> nearest;
  std::int32_t hint = -1;
  for (const Vector3d& p : path.position) {
    t.at.emplace_back(T_BW * p);
    nearest.push_back(body.distance(t.at.back(), hint));
    hint = nearest.back().triangle;
    t.depth.push_back(o.radius - nearest.back().distance);
  }
  t.normal = path_normals(body.surface, shading, t.at, o.smoothing);
  double strong = 0.0, pulled = 0.0;
  for (std::size_t i = 0; i < t.at.size(); ++i) {
    t.force.emplace_back(T_BW.linear() * force.force[i]);
    const double pressed = t.force.back().dot(t.normal[i]);
    t.touching.push_back(pressed > o.least_force);
    strong += t.force.back().norm() > o.least_force ? 1.0 : 0.0;
    pulled += pressed < -0.5 * t.force.back().norm() && -pressed > o.least_force ? 1.0 : 0.0;
    const bool moved = o.onto_surface && (t.touching.back() || t.depth[i] > 0.0);
    t.out.push_back(moved ? nearest[i].point : Vector3d(t.at[i] - o.radius * t.normal[i]));
  }
  t.inwards = strong > 0.0 ? pulled / strong : 0.0;
  return t;
}

ContactSamples samples_at_poses(const PoseStream& path, const Touch& touch,
                                const Eigen::Isometry3d& T_BW, double& noise) {
  ContactSamples samples;
  samples.time = path.time;
  samples.position = touch.out;
  samples.normal = touch.normal;
  samples.force = touch.force;
  samples.depth = touch.depth;
  PathVelocity found = path_velocity(path.time, path.position, velocity_width(path));
  noise = found.noise;
  for (const Vector3d& v : found.velocity) {
    samples.velocity.emplace_back(T_BW.linear() * v);
  }
  return samples;
}

/// Which poses lie on the body, with all those that their velocity is taken from: a probe that
/// comes or goes has no direction along the surface.
std::vector<bool> on_body(const PoseStream& path, const Touch& touch) {
  constexpr double kFar = 5.0;  // times the median of the contacts
  std::vector<double> distance;
  for (std::size_t i = 0; i < touch.depth.size(); ++i) {
    if (touch.touching[i]) {
      distance.push_back(std::abs(touch.depth[i]));
    }
  }
  std::vector<bool> on(path.size(), true);
  if (distance.empty()) {
    return on;
  }
  const double far = kFar * *analysis::quantile(distance, 0.5);
  const double reach = 0.5 * velocity_width(path);
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (std::abs(touch.depth[i]) <= far) {
      continue;
    }
    for (std::size_t j = i; j < path.size() && path.time[j] <= path.time[i] + reach; ++j) {
      on[j] = false;
    }
    for (std::size_t j = i; j > 0 && path.time[j - 1] >= path.time[i] - reach; --j) {
      on[j - 1] = false;
    }
  }
  return on;
}

/// Forces at the lag that the body's normals tell, where they tell it better than the poses alone.
/// Each lag turns the sensor into W anew, hence the rounds.
ForceStream refined_forces(const ContactRecording& recording, const PoseStream& path,
                           ForceStream forces, const Eigen::Isometry3d& T_BW,
                           const contact::FeltBody& body, const contact::Shading& shading,
                           const PrepareOptions& o, PreparedContact& result) {
  if (o.lag || path.size() < kFewestForLag) {
    return forces;
  }
  const ForceStream at_poses = resampled(forces, path.time, mean_period(path));
  const Touch touch = touch_body(path, at_poses, T_BW, body, shading, o);
  SurfaceWay way{path.time, {}, {}, on_body(path, touch)};
  for (const Vector3d& n : touch.normal) {
    way.normal.emplace_back(T_BW.linear().transpose() * n);
  }
  double noise = 0.0;
  way.velocity = samples_at_poses(path, touch, Eigen::Isometry3d::Identity(), noise).velocity;
  double as_friction = 0.0;
  bool like_friction = false;
  for (int round = 0; round < kLagRounds; ++round) {
    LagFit fit = estimate_surface_lag(way, forces, o.least_force);
    const double change = fit.lag;
    fit.lag += result.lag_used;
    fit.low += result.lag_used;
    fit.high += result.lag_used;
    const bool better =
        !result.lag->doubt.empty() || fit.high - fit.low < result.lag->high - result.lag->low;
    as_friction = std::abs(fit.as_friction);
    like_friction = fit.like_friction;
    if (!fit.doubt.empty() || (round == 0 && !better)) {
      break;
    }
    result.lag = fit;
    forces = forces_at(recording, fit.lag, o, result);
    if (std::abs(change) < kSameLag) {
      break;
    }
  }
  result.lag_like_friction = like_friction;
  if (result.lag->doubt.empty()) {
    result.friction_by_lag = 0.5 * as_friction * (result.lag->high - result.lag->low);
  } else if (like_friction) {
    result.friction_by_lag = std::numeric_limits<double>::infinity();
  }
  return forces;
}

/// The poses between the first and the last time that both streams have.
PoseStream overlapping(const PoseStream& path, const ForceStream& force) {
  PoseStream result;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (path.time[i] >= force.time.front() && path.time[i] <= force.time.back()) {
      result.time.push_back(path.time[i]);
      result.position.push_back(path.position[i]);
      result.orientation.push_back(path.orientation[i]);
    }
  }
  require(result.size() >= kFewestContacts,
          "12 poses or more must lie within the time of the forces");
  return result;
}

/// Takes the recorder's own depths, at the samples' times, which are poses' times.
void take_known_depth(const ContactRecording& recording, ContactSamples& samples) {
  if (recording.depth.empty()) {
    return;
  }
  const std::vector<double>& times = recording.pose.time;
  for (std::size_t i = 0; i < samples.time.size(); ++i) {
    const auto at = std::lower_bound(times.begin(), times.end(), samples.time[i]);
    samples.depth[i] = recording.depth[static_cast<std::size_t>(at - times.begin())];
  }
}

void remark_on_lag(const PrepareOptions& o, PreparedContact& result) {
  if (!o.lag && result.friction_by_lag == 0.0) {
    result.remarks.push_back(
        fmt::format("The interval of friction does not allow for an error of the lag, {}.",
                    result.lag->doubt.empty() ? "as there are too few poses" : "which is doubted"));
  }
}

/// Forces that friction does not explain.
void remark_on_lean(const Touch& touch, PreparedContact& result) {
  std::vector<double> lean;
  for (std::size_t i = 0; i < touch.force.size(); ++i) {
    if (touch.touching[i]) {
      const double normal = touch.force[i].dot(touch.normal[i]);
      lean.push_back((touch.force[i] - normal * touch.normal[i]).norm() / normal);
    }
  }
  const double median = lean.empty() ? 0.0 : *analysis::quantile(lean, 0.5);
  if (median > kMuchFriction) {
    result.remarks.push_back(fmt::format(
        "The force along the surface is {:.2f} times the normal one (median): more than friction "
        "explains. Either the body is registered wrongly, or the probe touches in several places.",
        median));
  }
}

/// Poses that were given in the body's frame, which no registration brought to the body.
/// @throws std::invalid_argument if they are far off and cannot belong to a body of that size
void judge_places(const Touch& touch, const contact::FeltBody& body, PreparedContact& result) {
  std::vector<Vector3d> contacts;
  std::vector<double> distance;
  for (std::size_t i = 0; i < touch.out.size(); ++i) {
    if (touch.touching[i]) {
      contacts.push_back(touch.at[i]);
      distance.push_back(std::abs(touch.depth[i]));
    }
  }
  const double median = *analysis::quantile(distance, 0.5);
  // A press at one place of the body is small, but on it.
  if (median > std::min(kOffBody * body.size, kFarFromBody * path_size(contacts))) {
    check_size(body, contacts);
  }
  remark_on_distance(median, contacts, result);
}

/// @throws std::invalid_argument if forces lead through the whole body
void judge_depth(const Touch& touch, const contact::FeltBody& body, const PreparedContact& result) {
  std::vector<double> depth;
  for (std::size_t i = 0; i < touch.out.size(); ++i) {
    if (touch.touching[i]) {
      depth.push_back((touch.out[i] - result.in[i]).norm());
    }
  }
  const double median = *analysis::quantile(depth, 0.5);
  if (median > body.size) {
    throw std::invalid_argument(fmt::format(
        "over {:g} N/m half of the forces lead more than {:.3g} m into a body of {:.3g} "
        "m; --stiffness, or the forces, are in another unit",
        result.stiffness, median, body.size));
  }
}

/// @throws std::invalid_argument if nothing touches
void judge_touch(const Touch& touch, PreparedContact& result) {
  require(result.contact_share > 0.0,
          "no force points out of the body where the probe is; is the mesh another body or "
          "in another unit (--units), do the forces act on the body (--on-body), or is the "
          "lag another one (--lag)?");
  remark_on_lean(touch, result);
  if (touch.inwards > kInwards) {
    result.remarks.push_back(fmt::format(
        "{:.0f} % of the forces pull into the body: perhaps the sensor says what acts on the body.",
        100.0 * touch.inwards));
  }
}

}  // namespace

PreparedContact prepare_contact(const ContactRecording& recording, const contact::FeltBody& body,
                                const PrepareOptions& options) {
  check_options(options);
  PreparedContact result;
  result.least_force = options.least_force;
  result.rate = options.rate;
  result.stiffness = options.stiffness;
  const PoseStream whole = tip_path(recording.pose, options.tip);
  ForceStream force = first_forces(recording, whole, options, result);
  const PoseStream path = overlapping(whole, force);
  const Eigen::Isometry3d T_BW =
      body_from_world(path, resampled(force, path.time, mean_period(path)), body, options, result);
  const contact::Shading shading(body.mesh, body.surface, options.crease_angle);
  force = refined_forces(recording, path, force, T_BW, body, shading, options, result);
  remark_on_load(options, result);
  remark_on_lag(options, result);
  const ForceStream at_poses = resampled(force, path.time, mean_period(path));
  result.samples = samples_at_poses(path, touch_body(path, at_poses, T_BW, body, shading, options),
                                    T_BW, result.velocity_noise);
  take_known_depth(recording, result.samples);

  result.time = even_times(path.time.front(), path.time.back(), 1.0 / options.rate);
  Touch touch =
      touch_body(resampled(path, result.time), resampled(force, result.time, 1.0 / options.rate),
                 T_BW, body, shading, options);
  result.in = in_trajectory(touch.out, touch.force, touch.normal, options.stiffness);
  result.contact_share =
      static_cast<double>(std::count(touch.touching.begin(), touch.touching.end(), true)) /
      static_cast<double>(touch.touching.size());
  judge_touch(touch, result);
  judge_depth(touch, body, result);
  if (options.registered) {
    judge_places(touch, body, result);
  }
  result.touching = std::move(touch.touching);
  result.out = std::move(touch.out);
  result.normal = std::move(touch.normal);
  result.force = std::move(touch.force);
  return result;
}

}  // namespace haptrial::evaluation
