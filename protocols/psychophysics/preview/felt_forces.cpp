#include "protocols/psychophysics/preview/felt_forces.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/base/definition/table.h"
#include "core/base/longest_of.h"
#include "core/base/parallel.h"
#include "core/scene/needed_damping.h"
#include "core/scene/scene.h"
#include "protocols/psychophysics/objects/deformable_bodies.h"
#include "protocols/psychophysics/preview/previewed_trial.h"

namespace haptrial::protocols {
namespace {

using Eigen::Vector3d;

constexpr int kSteps = 240;     // of a line
constexpr double kFelt = 1e-6;  // [N]
constexpr double kFast = 0.5;   // of a hand [m/s]

using Part = std::pair<double, double>;  // of a line: its ends [m]

scene::Scene scene_of(const FeltFields& felt) {
  std::vector<scene::Field> fields = felt.fields;
  for (scene::Field& field : fields) {
    field.fade_in = field.fade_out = 0.0;
    if (auto* body = std::get_if<scene::DeformableObjectParameters>(&field.kind)) {
      body->shape = nullptr;  // no picture: scenes of several threads have one body
    }
  }
  scene::Scene scene(fields, felt.rate);
  scene.switch_to(felt.mask);
  return scene;
}

std::vector<double> spread(double from, double to, std::size_t count) {
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = from + (to - from) * static_cast<double>(i) / static_cast<double>(count - 1);
  }
  return values;
}

/// Forces on a hand that is led from the origin outwards, once to either end of each line.
/// @param ends  of each line: below and above the origin [m]
std::array<ForceLine, 3> lines_to(const FeltStage& stage, const std::array<Part, 3>& ends) {
  std::array<double, 3> steps{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    steps[axis] = std::max((ends[axis].second - ends[axis].first) / kSteps, 1e-6);
  }
  std::array<std::vector<Vector3d>, 6> halves;  // of each line: below, above
  parallel_for(halves.size(), threads_or_all(0), [&](std::size_t half) {
    const std::size_t axis = half / 2;
    const double step = half % 2 == 0 ? -steps[axis] : steps[axis];
    const double end = half % 2 == 0 ? ends[axis].first : ends[axis].second;
    std::vector<Vector3d> way;
    for (int i = 0; i <= static_cast<int>(std::lround(end / step)); ++i) {
      way.push_back(stage.origin + step * i * Vector3d::Unit(static_cast<int>(axis)));
    }
    halves[half] = forces_along(stage.felt, way);
  });
  std::array<ForceLine, 3> lines;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    ForceLine& line = lines[axis];
    line.axis = static_cast<int>(axis);
    line.forces = std::move(halves[2 * axis]);
    const int below = static_cast<int>(line.forces.size()) - 1;
    std::ranges::reverse(line.forces);
    line.forces.pop_back();  // the origin itself
    std::ranges::copy(halves[2 * axis + 1], std::back_inserter(line.forces));
    for (int i = -below; std::ssize(line.offsets) < std::ssize(line.forces); ++i) {
      line.offsets.push_back(steps[axis] * i);
    }
  }
  return lines;
}

/// The part of a line over which the force changes, with some room; a tenth of the reach where it
/// does not.
Part part_that_matters(const ForceLine& line, double reach) {
  constexpr double kChange = 0.01;  // of the largest force
  constexpr double kRoom = 0.15;
  double low = 0.0, high = 0.0;
  const double least = std::max(kFelt, kChange * longest_of(line.forces));
  Vector3d before = line.forces.front();
  for (std::size_t i = 1; i < line.forces.size(); ++i) {
    if ((line.forces[i] - before).norm() > least) {
      low = std::min(low, line.offsets[i - 1]);
      high = std::max(high, line.offsets[i]);
      before = line.forces[i];
    }
  }
  const double room = std::max(0.1 * reach, kRoom * (high - low));
  return {std::max(-reach, low - room), std::min(reach, high + room)};
}

/// Lines are as long as the longest part that matters, so that they can be compared.
/// @returns the part of each line that matters
std::array<Part, 3> draw_lines(FeltStage& stage, double reach) {
  std::array<Part, 3> parts;
  double low = 0.0, high = 0.0;
  stage.lines = lines_to(stage, {Part{-reach, reach}, {-reach, reach}, {-reach, reach}});
  for (std::size_t axis = 0; axis < 3; ++axis) {
    parts[axis] = part_that_matters(stage.lines[axis], reach);
    low = std::min(low, parts[axis].first);
    high = std::max(high, parts[axis].second);
  }
  stage.lines = lines_to(stage, {Part{low, high}, {low, high}, {low, high}});
  return parts;
}

/// The place on the lines with about half of the largest force: a hand that touches, and whose
/// force no limit cuts. The origin where no force is felt.
Vector3d place_that_touches(const FeltStage& stage) {
  double most = 0.0;
  for (const ForceLine& line : stage.lines) {
    most = std::max(most, longest_of(line.forces));
  }
  Vector3d place = stage.origin;
  double nearest = most > kFelt ? most : -1.0;
  for (const ForceLine& line : stage.lines) {
    for (std::size_t i = 0; i < line.offsets.size(); ++i) {
      const double off = std::abs(line.forces[i].norm() - 0.5 * most);
      if (off < nearest) {
        nearest = off;
        place = stage.origin + line.offsets[i] * Vector3d::Unit(line.axis);
      }
    }
  }
  return place;
}

std::array<SpeedCurve, 3> speeds_at(const FeltFields& felt, const Vector3d& place, double fastest) {
  constexpr std::size_t kSpeeds = 21;
  const std::vector<double> speeds = spread(-fastest, fastest, kSpeeds);
  const Vector3d at_rest = settled_force(felt, place, Vector3d::Zero());
  std::array<SpeedCurve, 3> curves;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    curves[axis] = {static_cast<int>(axis), speeds, std::vector<Vector3d>(kSpeeds)};
  }
  parallel_for(3 * kSpeeds, threads_or_all(0), [&](std::size_t i) {
    SpeedCurve& curve = curves[i / kSpeeds];
    const Vector3d velocity = speeds[i % kSpeeds] * Vector3d::Unit(curve.axis);
    curve.forces[i % kSpeeds] = settled_force(felt, place, velocity) - at_rest;
  });
  return curves;
}

/// At the start, where springs do not cut what the velocity adds, unless nothing resists there.
void draw_speeds(FeltStage& stage, double fastest) {
  stage.moved_at = stage.origin;
  stage.speeds = speeds_at(stage.felt, stage.origin, fastest);
  if (!stage.resists_motion()) {
    stage.moved_at = stage.touched;
    stage.speeds = speeds_at(stage.felt, stage.touched, fastest);
  }
}

void draw_course(FeltStage& stage, double duration) {
  const auto ticks = static_cast<std::size_t>(std::lround(duration * stage.felt.rate));
  std::vector<Vector3d> course = forces_over_time(stage.felt, stage.touched, ticks);
  const double least = std::max(kFelt, 0.01 * longest_of(course));
  const bool changes = std::ranges::any_of(
      course, [&](const Vector3d& force) { return (force - course.front()).norm() > least; });
  stage.course = changes ? std::move(course) : std::vector<Vector3d>();
}

/// The axis along which the force differs most, and another one.
void choose_plane(const FeltStage& stage, bool from_above, ForcePlane& plane) {
  double most = -1.0;
  int strongest = 0;
  for (const ForceLine& line : stage.lines) {
    double change = 0.0;
    for (const Vector3d& force : line.forces) {
      change = std::max(change, (force - line.forces.front()).norm());
    }
    if (change > 1.001 * most + kFelt) {
      most = change;
      strongest = line.axis;
    }
  }
  plane.across = 0;
  plane.up = strongest != 0 ? strongest : from_above ? 2 : 1;
}

/// Forces along a row, on a hand that is led from the origin to the row and along it to one end.
std::vector<Vector3d> half_row(const FeltStage& stage, double up, std::span<const double> across) {
  constexpr int kWayToRow = 12;  // steps
  const ForcePlane& plane = stage.plane;
  const Vector3d across_unit = Vector3d::Unit(plane.across), up_unit = Vector3d::Unit(plane.up);
  std::vector<Vector3d> way;
  for (int i = 0; i < kWayToRow; ++i) {
    way.push_back(stage.origin + up * i / kWayToRow * up_unit);
  }
  for (const double offset : across) {
    way.push_back(stage.origin + offset * across_unit + up * up_unit);
  }
  std::vector<Vector3d> forces = forces_along(stage.felt, way);
  forces.erase(forces.begin(), forces.begin() + kWayToRow);
  return forces;
}

void draw_rows(FeltStage& stage, const std::vector<double>& columns,
               const std::vector<double>& rows) {
  ForcePlane& plane = stage.plane;
  plane.columns = columns.size();
  plane.forces.resize(rows.size() * columns.size());
  const auto middle = std::ranges::lower_bound(columns, 0.0);
  const std::vector<double> left(std::make_reverse_iterator(middle), columns.rend());
  parallel_for(2 * rows.size(), threads_or_all(0), [&](std::size_t half) {
    const auto first = plane.forces.begin() + std::ssize(columns) * static_cast<long>(half / 2);
    if (half % 2 == 0) {
      std::ranges::reverse_copy(half_row(stage, rows[half / 2], left), first);
    } else {
      std::ranges::copy(half_row(stage, rows[half / 2], std::span(middle, columns.end())),
                        first + std::ssize(left));
    }
  });
  for (const double row : rows) {
    for (const double column : columns) {
      plane.places.push_back(stage.origin + column * Vector3d::Unit(plane.across) +
                             row * Vector3d::Unit(plane.up));
    }
  }
}

void draw_plane(FeltStage& stage, const std::array<Part, 3>& parts, bool from_above,
                const FeltLook& look) {
  constexpr std::size_t kArrows = 15;  // in each direction
  ForcePlane& plane = stage.plane;
  choose_plane(stage, from_above, plane);
  if (look.plane) {
    plane.across = look.plane->front();
    plane.up = look.plane->back();
  }
  const Part& across = parts[static_cast<std::size_t>(plane.across)];
  const Part& up = parts[static_cast<std::size_t>(plane.up)];
  const double half = 0.5 * std::max(across.second - across.first, up.second - up.first);
  const auto square = [&](const Part& part) {
    const double centre = 0.5 * (part.first + part.second);
    return spread(centre - half, centre + half, kArrows);
  };
  draw_rows(stage, square(across), square(up));
}

std::vector<FieldNumbers> numbers_of(const TrialsDefinition& d, const FeltFields& felt) {
  std::vector<FieldNumbers> all;
  Table root = d.root();
  for (std::size_t i = 0; i < felt.fields.size(); ++i) {
    if ((felt.mask >> i & 1U) == 0) {
      continue;
    }
    const scene::Field& field = felt.fields[i];
    const scene::StiffnessBound bound = scene::stiffness_bound(felt.fields, i);
    FieldNumbers numbers{
        field.name,    "object",      bound.stiffness,
        bound.damping, bound.passive, scene::needed_damping_below(0.0, bound, felt.rate),
        field.limit,   field.fade_in, field.fade_out};
    if (root.has("fields") && !scene::traits_of(field).object) {
      numbers.type = root.table("fields").table(field.name).whole_text("type").value_or("");
    }
    all.push_back(std::move(numbers));
  }
  return all;
}

bool same_lines(const FeltStage& a, const FeltStage& b) {
  const auto same = [](const ForceLine& one, const ForceLine& other) {
    return one.offsets == other.offsets && one.forces == other.forces;
  };
  const auto same_speeds = [](const SpeedCurve& one, const SpeedCurve& other) {
    return one.forces == other.forces;
  };
  return a.device == b.device && a.felt.mask == b.felt.mask && a.origin == b.origin &&
         std::ranges::equal(a.lines, b.lines, same) &&
         std::ranges::equal(a.speeds, b.speeds, same_speeds) && a.course == b.course;
}

/// How long the force of a stage is looked at [s].
double looked_at(const PreviewedStage& stage) {
  constexpr double kLongest = 3.0;
  return std::clamp(stage.longest, 0.01, kLongest);
}

/// The stages of a trial in which a field acts, on each device that is a tip.
std::vector<FeltStage> stages_with_fields(const TrialsDefinition& d, const PreviewedTrial& trial,
                                          const std::vector<DeviceArm>& arms,
                                          const FeltLook& look) {
  std::vector<FeltStage> all;
  for (std::size_t interval = 0; interval < trial.intervals.size(); ++interval) {
    const PreviewedInterval& shown = trial.intervals[interval];
    std::vector<scene::Field> fields = shown.presented.fields;
    prepare_bodies(fields, d.rate);
    for (std::size_t stage = 0; stage < shown.stages.size(); ++stage) {
      for (std::size_t device = 0; device < shown.presented.felt.size(); ++device) {
        const std::uint64_t mask =
            shown.presented.stages[stage].stage.fields & shown.presented.felt[device];
        if (mask == 0 || arms[device].part != device::Part::kTip) {
          continue;
        }
        FeltStage felt;
        felt.where = {{interval, stage}};
        felt.device = device;
        felt.felt = {fields, mask, d.rate};
        felt.origin = look.through.value_or(device == 0 ? shown.start : d.hands[device].start);
        all.push_back(std::move(felt));
      }
    }
  }
  return all;
}

}  // namespace

std::vector<Vector3d> forces_along(const FeltFields& felt, std::span<const Vector3d> way) {
  scene::Scene scene = scene_of(felt);
  std::vector<Vector3d> forces;
  forces.reserve(way.size());
  for (const Vector3d& place : way) {
    forces.push_back(scene.force({place, Vector3d::Zero()}));
  }
  return forces;
}

Vector3d settled_force(const FeltFields& felt, const Vector3d& place, const Vector3d& velocity) {
  constexpr double kSettled = 0.1;  // [s]
  constexpr int kStill = 25;        // ticks without any change, after which none is expected
  scene::Scene scene = scene_of(felt);
  Vector3d force = Vector3d::Zero();
  int still = 0;
  for (double time = 0.0; time < kSettled && still < kStill; time += 1.0 / felt.rate) {
    const Vector3d now = scene.force({place, velocity});
    still = now == force ? still + 1 : 0;
    force = now;
  }
  return force;
}

std::vector<Vector3d> forces_over_time(const FeltFields& felt, const Vector3d& place,
                                       std::size_t ticks) {
  const std::vector<Vector3d> way(ticks, place);
  return forces_along(felt, way);
}

bool FeltStage::is_felt() const {
  return std::ranges::any_of(lines,
                             [](const auto& line) { return longest_of(line.forces) > kFelt; }) ||
         resists_motion() || longest_of(course) > kFelt;
}

bool FeltStage::resists_motion() const {
  return std::ranges::any_of(speeds,
                             [](const auto& curve) { return longest_of(curve.forces) > kFelt; });
}

std::vector<FeltStage> felt_stages(const TrialsDefinition& d, const PreviewedTrial& trial,
                                   const FeltLook& look) {
  const std::vector<DeviceArm> arms = d.arms();
  std::vector<FeltStage> all = stages_with_fields(d, trial, arms, look);
  std::vector<std::array<Part, 3>> parts(all.size());
  parallel_for(all.size(), threads_or_all(0), [&](std::size_t i) {
    FeltStage& felt = all[i];
    const device::EnvelopeLimits& limits = arms[felt.device].limits;
    const StagePlace& at = felt.where.front();
    parts[i] = draw_lines(felt, limits.workspace_radius);
    felt.touched = place_that_touches(felt);
    draw_speeds(felt, std::min(kFast, limits.max_speed));
    draw_course(felt, looked_at(trial.intervals[at.interval].stages[at.stage]));
  });
  std::vector<FeltStage> stages;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto same = std::ranges::find_if(
        stages, [&](const FeltStage& other) { return same_lines(all[i], other); });
    if (same != stages.end()) {
      same->where.push_back(all[i].where.front());
      continue;
    }
    draw_plane(all[i], parts[i], d.view.from_above, look);
    all[i].fields = numbers_of(d, all[i].felt);
    stages.push_back(std::move(all[i]));
  }
  return stages;
}

}  // namespace haptrial::protocols
