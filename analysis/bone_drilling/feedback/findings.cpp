#include "analysis/bone_drilling/feedback/findings.h"

#include <algorithm>
#include <utility>

#include "analysis/bone_drilling/metrics/in_order.h"
#include "core/bone/model/distance_field.h"

namespace haptrial::analysis::drilling {
namespace {

MetricOptions metric_options(const SafeOptions& options) {
  MetricOptions metrics;
  metrics.bins = options.bins;
  metrics.phases = options.phases;
  return metrics;
}

/// The labels of a bone after all removals, cuts and crumbs.
std::vector<std::uint8_t> labels_left(const Procedure& procedure) {
  struct Visitor {
    StandingBone bone;
    void view(const View&) {}
    void tick(const ToolTick&) {}
    void crumb(const Debris& crumb) { bone.take_part(crumb.voxel); }
    void removal(const Removal& removal) { bone.take(removal.voxel); }
    void cut(const Removal& cut) { bone.take(cut.voxel); }
  };
  Visitor visitor{StandingBone(procedure.bone)};
  visit_in_order(procedure, visitor);
  std::vector<std::uint8_t> labels = procedure.bone->labels;
  const geometry::VoxelGrid& grid = procedure.bone->grid;
  geometry::visit_voxels(grid, [&](const bone::Voxel& voxel, std::size_t at) {
    if (!visitor.bone.holds(voxel)) {
      labels[at] = 0;
    }
  });
  return labels;
}

/// Places of the tip along each stroke.
std::vector<std::vector<Eigen::Vector3f>> paths_of(const Procedure& procedure) {
  constexpr double kStep = 0.02;  // a tip is never faster than a picture shows [s]
  const auto step = static_cast<std::size_t>(std::max(1.0, kStep * procedure.rate));
  std::vector<std::vector<Eigen::Vector3f>> paths;
  for (const Stroke& stroke : find_strokes(procedure)) {
    std::vector<Eigen::Vector3f> path;
    for (std::size_t tick = stroke.first; tick < stroke.last; tick += step) {
      path.push_back(procedure.ticks[tick].position.cast<float>());
    }
    path.push_back(procedure.ticks[stroke.last].position.cast<float>());
    paths.push_back(std::move(path));
  }
  return paths;
}

std::vector<double> times_of(const Procedure& procedure) {
  std::vector<double> times;
  std::size_t tick = 0;
  for (const Removal& removal : procedure.removals) {
    while (tick < procedure.ticks.size() && procedure.ticks[tick].sequence < removal.sequence) {
      ++tick;
    }
    times.push_back(static_cast<double>(tick) / procedure.rate);
  }
  return times;
}

const SafeProfile* profile_of(const Experts& experts, const std::string& structure) {
  const auto at = std::find(experts.structures.begin(), experts.structures.end(), structure);
  return at == experts.structures.end()
             ? nullptr
             : &experts.profiles[static_cast<std::size_t>(at - experts.structures.begin())];
}

void judge(const Procedure& procedure, const Experts& experts, Findings& f) {
  std::vector<const SafeProfile*> profiles;
  for (const std::string& structure : f.structures) {
    profiles.push_back(profile_of(experts, structure));
  }
  const auto faulty = [&f](std::size_t n, bool is, Fault fault) {
    f.faults[n] = static_cast<std::uint8_t>(f.faults[n] | (is ? fault : 0));
  };
  for (std::size_t n = 0; n < procedure.removals.size(); ++n) {
    const std::uint8_t label = procedure.removals[n].label;
    faulty(n, f.summary.visibility.visible[n] == 0, kHiddenFault);
    faulty(n, label < procedure.bone->structures.size() && procedure.bone->structures[label].vital,
           kVitalFault);
    const NearestRemoval& near = f.nearest[n];
    const SafeProfile* profile =
        near.structure < 0 ? nullptr : profiles[static_cast<std::size_t>(near.structure)];
    const SafeBin* bin =
        profile == nullptr ? nullptr : profile->at(static_cast<double>(near.at.distance));
    if (bin != nullptr && bin->force) {
      f.judged[n] = 1;
      faulty(n, static_cast<double>(near.at.force) > bin->force->high, kForceFault);
      faulty(n, static_cast<double>(near.at.speed) > bin->speed->high, kSpeedFault);
    }
  }
}

}  // namespace

std::size_t Findings::count(std::uint8_t fault) const {
  return static_cast<std::size_t>(std::count_if(
      faults.begin(), faults.end(), [fault](std::uint8_t each) { return (each & fault) != 0; }));
}

ExpertProcedure expert_procedure(const Procedure& procedure, const SafeOptions& options,
                                 StudyBones& bones) {
  ExpertProcedure expert;
  expert.summary = summarize(procedure, metric_options(options), bones);
  expert.summary.removed = {};
  expert.summary.removed_seen = {};
  expert.summary.near = {};
  expert.summary.visibility.visible = {};
  expert.structures = bone::vital_structures(*procedure.bone);
  expert.removals = nearest_structures(procedure, expert.structures, bones, options.bins.reach);
  return expert;
}

Experts experts_of(std::span<const ExpertProcedure> procedures, const std::string& without,
                   const SafeOptions& options) {
  Experts experts;
  std::vector<std::vector<NearestRemoval>> renamed;
  std::vector<SafeCase> cases;
  const auto number_in = [](std::vector<std::string>& names, const std::string& name) {
    const auto at = std::find(names.begin(), names.end(), name);
    const auto number = static_cast<std::int32_t>(at - names.begin());
    if (at == names.end()) {
      names.push_back(name);
    }
    return number;
  };
  for (const ExpertProcedure& procedure : procedures) {
    if (procedure.summary.participant == without) {
      continue;
    }
    number_in(experts.participants, procedure.summary.participant);
    experts.simulated = experts.simulated || procedure.summary.simulated;
    experts.summaries.push_back(procedure.summary);
    std::vector<std::int32_t> numbers;
    for (const std::string& name : procedure.structures) {
      numbers.push_back(number_in(experts.structures, name));
    }
    renamed.push_back(procedure.removals);
    for (NearestRemoval& removal : renamed.back()) {
      removal.structure =
          removal.structure < 0 ? -1 : numbers[static_cast<std::size_t>(removal.structure)];
    }
  }
  for (std::size_t n = 0; n < renamed.size(); ++n) {
    cases.push_back({experts.summaries[n].participant, renamed[n]});
  }
  experts.profiles = learn_safe_values(cases, experts.structures, options);
  return experts;
}

Findings findings_of(const Procedure& procedure, const Experts& experts, StudyBones& bones,
                     const SafeOptions& options) {
  Findings f;
  f.summary = summarize(procedure, metric_options(options), bones);
  f.structures = bone::vital_structures(*procedure.bone);
  f.nearest = nearest_structures(procedure, f.structures, bones, options.bins.reach);
  f.faults.assign(procedure.removals.size(), 0);
  f.judged.assign(procedure.removals.size(), 0);
  for (const Removal& removal : procedure.removals) {
    f.voxels.push_back(removal.voxel);
  }
  judge(procedure, experts, f);
  f.times = times_of(procedure);
  f.labels_left = labels_left(procedure);
  f.strokes = paths_of(procedure);
  f.pose_WB = procedure.pose_WB;
  f.plan = procedure.plans.cavity;
  return f;
}

}  // namespace haptrial::analysis::drilling
