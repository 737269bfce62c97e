#include "core/subject/drilling/drilling_skill.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/random.h"

namespace haptrial::subject {

DrillingSkill drilling_skill(double skill) noexcept {
  const double s = std::clamp(skill, 0.0, 1.0);
  const auto line = [s](double novice, double expert) { return novice + s * (expert - novice); };
  DrillingSkill k{};
  k.near_force = line(0.24, 0.13);
  k.far_force = line(2.4, 2.2);
  k.near_distance = line(0.0, 0.5e-3);
  k.far_distance = line(1.0e-3, 3.0e-3);
  k.stroke_rate = line(1.0, 1.4);
  k.near_pace = line(1.0, 0.7);
  k.stroke_length = line(4e-3, 8e-3);
  k.pause = line(0.30, 0.05);
  k.force_noise = line(0.20, 0.05);
  k.tremor = line(0.06, 0.03);
  k.misjudgement = line(1.4e-3, 0.1e-3);
  k.extra_margin = line(0.0, 0.3e-3);
  k.region_error = line(2.5e-3, 0.4e-3);
  k.saucer = line(0.60, 1.0);
  k.evenness = line(0.10, 1.0);
  k.bite = line(3.0e-3, 1.5e-3);
  k.undercut = line(0.25, 0.0);
  k.looking = line(0.10, 0.90);
  k.look_error = line(0.30, 0.08);
  k.careful = line(0.20, 1.0);
  k.completeness = line(0.70, 0.94);
  return k;
}

double skill_in(double group_skill, const SkillSpread& spread, std::uint64_t participant_seed,
                int procedure) {
  RandomStream person(participant_seed, "skill");
  RandomStream day(participant_seed, fmt::format("skill of procedure {}", procedure + 1));
  double skill = std::clamp(group_skill + spread.between * person.normal(), 0.0, 1.0);
  for (int p = 0; p < procedure; ++p) {
    skill += spread.learning * (1.0 - skill);
  }
  return std::clamp(skill + spread.within * day.normal(), 0.0, 1.0);
}

}  // namespace haptrial::subject
