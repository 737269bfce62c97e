#include "protocols/psychophysics/definition/beginning_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/device/handle_part.h"
#include "core/scene/scene.h"
#include "protocols/psychophysics/definition/presented.h"
#include "protocols/psychophysics/definition/trials_definition.h"

namespace haptrial::protocols {
namespace {

using Eigen::Vector3d;

constexpr double kUnnoticed = 1.0;  // [N]

bool has_bit(std::uint64_t mask, std::size_t bit) { return (mask >> bit & 1U) != 0; }

/// Fields as they are felt by a hand at rest once they are faded in. The dampers of objects take
/// the way out of a body for a movement on the first tick.
std::vector<scene::Field> felt_at_rest(std::vector<scene::Field> fields) {
  for (scene::Field& field : fields) {
    field.fade_in = field.fade_out = 0.0;
    if (auto* object = std::get_if<scene::RigidObjectParameters>(&field.kind)) {
      object->gains.damping = 0.0;
    }
  }
  return fields;
}

/// Regions that hold the device's tool until the stage begins: those that the stage before waits
/// for, if it cannot end without them.
std::vector<scene::Shape> regions_before(const Presented& presented, std::size_t stage,
                                         std::size_t device) {
  std::vector<scene::Shape> regions;
  if (stage == 0) {
    return regions;
  }
  const Stage& before = presented.stages[stage - 1].stage;
  if (std::isfinite(before.timeout) && before.late == Consequence::kGoOn) {
    return regions;
  }
  for (std::size_t i = 0; i < presented.regions.size(); ++i) {
    if (has_bit(before.until.inside, i) && presented.region_devices[i] == device &&
        !presented.of_cursor[i]) {
      regions.push_back(presented.regions[i].shape);
    }
  }
  return regions;
}

/// A grid in the ball of this radius about the centre. @param steps  to each side
void add_grid(const Vector3d& centre, double radius, int steps, std::vector<Vector3d>& places) {
  for (int x = -steps; x <= steps; ++x) {
    for (int y = -steps; y <= steps; ++y) {
      for (int z = -steps; z <= steps; ++z) {
        const Vector3d offset = Vector3d(x, y, z) / steps;
        if (offset.squaredNorm() <= 1.0) {
          places.push_back(centre + radius * offset);
        }
      }
    }
  }
}

/// Places that a hand may have when a stage begins, in the regions and in the workspace.
std::vector<Vector3d> places_within(const std::vector<scene::Shape>& regions, double reach) {
  constexpr int kFine = 10, kCoarse = 5;  // regions are small
  std::vector<Vector3d> places;
  add_grid(Vector3d::Zero(), reach, kFine, places);
  for (const scene::Shape& region : regions) {
    if (const double radius = scene::ball_of(region).radius; radius > 0.0) {
      add_grid(scene::place_inside(region), radius, kCoarse, places);
    }
  }
  std::vector<scene::PlacedShape> placed(regions.begin(), regions.end());
  std::erase_if(places, [&](const Vector3d& p) {
    return p.norm() > reach ||
           std::ranges::any_of(placed, [&](const auto& region) { return !region.contains(p); });
  });
  return places;
}

}  // namespace

BeginningReport::BeginningReport(const TrialsDefinition& definition)
    : rate_(definition.rate), arms_(definition.arms()) {}

double BeginningReport::most(const Presented& presented, std::size_t field,
                             std::size_t device) const {
  return std::min(presented.fields[field].limit, arms_[device].limits.max_force);
}

/// Fields that begin and may push harder than is known. A force that the definition asks for is
/// meant, wherever the hand is.
std::vector<std::size_t> BeginningReport::unknown(const Presented& presented, std::size_t stage,
                                                  std::size_t device, std::uint64_t begins) const {
  std::vector<std::size_t> fields;
  for (std::size_t i = 0; i < presented.fields.size(); ++i) {
    const auto known = pushes_.find({stage, i});
    const double force = known != pushes_.end() ? known->second.force : 0.0;
    if (has_bit(begins, i) && scene::traits_of(presented.fields[i]).asked_force == 0.0 &&
        force < most(presented, i, device)) {
      fields.push_back(i);
    }
  }
  return fields;
}

void BeginningReport::look(const Presented& presented, std::size_t stage, std::size_t device,
                           std::vector<std::size_t> fields, scene::Scene& scene) {
  const std::uint64_t felt = presented.stages[stage].stage.fields & presented.felt[device];
  const std::vector<Vector3d> places = places_within(regions_before(presented, stage, device),
                                                     arms_[device].limits.workspace_radius);
  for (const Vector3d& place : places) {
    scene.switch_to(0);
    scene.switch_to(felt);
    scene.force({place, Vector3d::Zero()});
    std::erase_if(fields, [&](std::size_t i) {
      const scene::FieldState& state = scene.state(i);
      const double most_force = most(presented, i, device);
      const double force = std::min((state.force - state.stimulus).norm(), most_force);
      const scene::Field& field = presented.fields[i];
      Push& push = pushes_[{stage, i}];
      if (force > push.force) {
        push = {presented.stages[stage].name,
                (scene::traits_of(field).object ? "objects." : "fields.") + field.name, force,
                std::max(field.fade_in, 0.05), device};
      }
      return force >= most_force;
    });
    if (fields.empty()) {
      return;
    }
  }
}

void BeginningReport::add(const Presented& presented) {
  std::optional<scene::Scene> scene;
  std::uint64_t before = 0;
  for (std::size_t stage = 0; stage < presented.stages.size(); ++stage) {
    const std::uint64_t mask = presented.stages[stage].stage.fields;
    for (std::size_t device = 0; device < arms_.size(); ++device) {
      const std::uint64_t begins = mask & ~before & presented.felt[device];
      std::vector<std::size_t> fields = unknown(presented, stage, device, begins);
      if (!fields.empty()) {
        if (!scene) {
          scene.emplace(felt_at_rest(presented.fields), rate_);
        }
        look(presented, stage, device, std::move(fields), *scene);
      }
    }
    before = mask;
  }
}

std::vector<std::string> BeginningReport::lines() const {
  std::vector<std::string> lines;
  for (const auto& [key, push] : pushes_) {
    if (push.force > kUnnoticed) {
      const device::PartUnits unit = arms_[push.device].units();
      lines.push_back(
          fmt::format("stage {}: {} may begin where the hand is, and then pushes it with up to "
                      "{:.3g} {}, which "
                      "come within {:g} s",
                      push.stage, push.field, unit.newton * push.force, unit.force, push.within));
    }
  }
  return lines;
}

namespace {

using device::Part;

/// The figures of one part by a certificate, and words for the part.
struct CertifiedPart {
  Part part;
  const device::CertifiedForce& figures;
  std::string file;

  const char* unit() const { return device::units_of(part, 1.0).force; }
  const char* force() const { return device::force_word(part); }
  const char* owner() const { return part == Part::kTip ? "device" : device::part_word(part); }
};

void add_track(const Track& track, const CertifiedPart& c, std::vector<std::string>& all) {
  if (track.unit != c.unit() || !track.range_known) {
    return;
  }
  const device::CertifiedForce& figures = c.figures;
  if (figures.dead_zone && track.low < *figures.dead_zone) {
    all.push_back(fmt::format(
        "{}: its levels begin at {:g} {}, but the certificate {} says that commands up to {:.3g} "
        "{} give no {}",
        track.name, track.low, c.unit(), c.file, *figures.dead_zone, c.unit(), c.force()));
  } else if (figures.friction && track.low < *figures.friction) {
    all.push_back(fmt::format(
        "{}: its levels begin at {:g} {}, but the certificate {} says that the {}'s friction is "
        "{:.3g} {}, which hides less",
        track.name, track.low, c.unit(), c.file, c.owner(), *figures.friction, c.unit()));
  }
  if (figures.force_noise && track.resolution > 0.0 && track.resolution < *figures.force_noise) {
    all.push_back(fmt::format(
        "{}: its levels are {:g} {} apart, but the certificate {} says that the {}'s {} ripples by "
        "{:.3g} {}",
        track.name, track.resolution, c.unit(), c.file, c.owner(), c.force(), *figures.force_noise,
        c.unit()));
  }
}

void add_stiffest(const StiffestStage& stiffest, const CertifiedPart& c,
                  std::vector<std::string>& all) {
  if (!c.figures.stiffest_wall || stiffest.stiffness <= *c.figures.stiffest_wall) {
    return;
  }
  const char* unit = c.part == Part::kRotation ? "N·m/rad" : "N/m";
  all.push_back(fmt::format(
      "stage {}: its fields{} add up to {:.4g} {}, but the certificate {} says that {:.4g} {} is "
      "the stiffest {} that stays passive while nobody holds the handle",
      stiffest.name, c.part == Part::kTip ? "" : fmt::format(" on the {}", c.owner()),
      stiffest.stiffness, unit, c.file, *c.figures.stiffest_wall, unit,
      c.part == Part::kTip ? "wall" : "spring"));
}

}  // namespace

std::vector<std::string> certificate_warnings(const TrialsDefinition& definition,
                                              const FeltParts& parts) {
  std::vector<std::string> all;
  if (!definition.certificate) {
    return all;
  }
  const device::Certificate& c = *definition.certificate;
  const auto felt = [&](Part part) { return parts[static_cast<std::size_t>(part)].felt; };
  std::vector<CertifiedPart> certified;
  if (felt(Part::kTip) || !felt(Part::kGrip)) {
    certified.push_back({Part::kTip, c, c.file});
  }
  if (c.rotation && felt(Part::kRotation)) {
    certified.push_back({Part::kRotation, *c.rotation, c.file});
  }
  if (c.grip && felt(Part::kGrip)) {
    certified.push_back({Part::kGrip, *c.grip, c.file});
  }
  for (const CertifiedPart& part : certified) {
    for (const Track& track : definition.tracks) {
      add_track(track, part, all);
    }
    add_stiffest(parts[static_cast<std::size_t>(part.part)].stiffest, part, all);
  }
  return all;
}

}  // namespace haptrial::protocols
