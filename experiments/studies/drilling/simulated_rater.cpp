#include "experiments/studies/drilling/simulated_rater.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "analysis/bone_drilling/metrics/achieved.h"
#include "analysis/bone_drilling/metrics/procedure.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/bone/record/drilling_tables.h"
#include "core/bone/record/recorded_bone.h"
#include "core/record/read/session_reader.h"
#include "core/subject/drilling/cavity_chart.h"
#include "experiments/study/study_files.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/bone_drilling/definition/placement.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
namespace drilling = analysis::drilling;
using subject::DrillingChart;

constexpr double kOpened = 2e-3;  // of bone gone in a column of the cavity [m]

/// The first bone of every column now.
struct Floor {
  std::vector<float> depth;  // (u x v) [m]
  std::vector<bool> made;    // (u x v) what lay on it was bone: it is no wall of an air cell
};

Floor floor_of(const bone::BoneModel& model, const std::vector<std::uint8_t>& standing,
               const Eigen::Isometry3d& X_BW, const DrillingChart& chart) {
  Floor floor{std::vector<float>(chart.columns(), DrillingChart::kNone),
              std::vector<bool>(chart.columns(), false)};
  const geometry::VoxelGrid& grid = model.grid;
  for (int v = 0; v < chart.size[1]; ++v) {
    for (int u = 0; u < chart.size[0]; ++u) {
      bool bone_above = false;
      for (int layer = 0; layer < 2 * chart.size[2]; ++layer) {
        const double w = 0.5 * layer * chart.cell;
        const Eigen::Vector3d p = X_BW * chart.world({u * chart.cell, v * chart.cell, w});
        const bone::Voxel at = grid.nearest(p);
        const bool inside = grid.contains(at);
        const std::size_t index = inside ? grid.index(at) : 0;
        if (inside && standing[index] != 0) {
          floor.depth[chart.column(u, v)] = static_cast<float>(w);
          floor.made[chart.column(u, v)] = bone_above;
          break;
        }
        bone_above = inside && model.labels[index] != 0;
      }
    }
  }
  return floor;
}

struct Roughness {
  double all{0.0};     // [m]
  double carved{0.0};  // at most as much [m]
};

Roughness roughness_of(const DrillingChart& chart, const Floor& floor) {
  const auto opened = [&](std::size_t column) {
    return floor.depth[column] != DrillingChart::kNone &&
           static_cast<double>(floor.depth[column] - chart.surface[column]) > kOpened;
  };
  Roughness sum;
  int count = 0;
  for (int v = 1; v + 1 < chart.size[1]; ++v) {
    for (int u = 1; u + 1 < chart.size[0]; ++u) {
      const std::size_t here = chart.column(u, v);
      std::array<float, 8> around{};
      std::size_t known = 0;
      bool made = floor.made[here];
      for (int dv = -1; dv <= 1; ++dv) {
        for (int du = -1; du <= 1; ++du) {
          const std::size_t column = chart.column(u + du, v + dv);
          if (column != here && opened(column)) {
            around[known++] = floor.depth[column];
            made = made && floor.made[column];
          }
        }
      }
      if (known == around.size() && opened(here)) {
        std::nth_element(around.begin(), around.begin() + 4, around.end());
        const auto off = std::abs(static_cast<double>(floor.depth[here] - around[4]));
        sum.all += off;
        sum.carved += made ? off : 0.0;
        ++count;
      }
    }
  }
  const double share = count > 0 ? 1.0 / count : 0.0;
  return {share * sum.all, share * sum.carved};
}

/// Remaining bone of one procedure: its last one, if it was begun anew.
std::vector<std::uint8_t> standing_after(const record::SessionReader& session,
                                         const bone::BoneModel& model, int trial) {
  std::vector<std::uint8_t> standing(model.labels.size());
  std::transform(model.labels.begin(), model.labels.end(), standing.begin(),
                 [](std::uint8_t label) { return label != 0 ? std::uint8_t{1} : std::uint8_t{0}; });
  std::int32_t last = 0;
  for (const record::PassRow& pass : session.passes()) {
    last = pass.trial == trial && !pass.practice ? std::max(last, pass.repetition) : last;
  }
  const std::vector<record::RemovalRow> removals = session.rows<record::RemovalRow>();
  for (const record::PassRow& pass : session.passes()) {
    if (pass.trial != trial || pass.practice || pass.repetition != last) {
      continue;
    }
    const auto from = std::lower_bound(
        removals.begin(), removals.end(), pass.first_sample,
        [](const record::RemovalRow& row, std::uint64_t at) { return row.sequence < at; });
    for (auto row = from; row != removals.end() && row->sequence <= pass.last_sample; ++row) {
      standing[model.grid.index(row->voxel[0], row->voxel[1], row->voxel[2])] = 0;
    }
  }
  return standing;
}

/// All that rating one bone again and again needs once.
struct RatedBone {
  bone::BoneModel model;
  Eigen::Isometry3d X_WB;
  DrillingChart chart;
  subject::CavityPlan plan;
};

std::vector<RatedBone> bones_of(const record::SessionReader& session) {
  const record::SessionInfo& info = session.info();
  const protocols::BoneDefinition d =
      protocols::parse_bone_definition(info.definition, info.definition_name);
  if (!d.cavity) {
    throw InputError(
        fmt::format("{}: its definition has no table [cavity]; a simulated rater needs one",
                    session.path().string()));
  }
  std::vector<RatedBone> bones;
  for (const record::BoneRecord& record : record::recorded_bones(session)) {
    RatedBone bone;
    bone.model = bone::bone_of(record);
    bone.X_WB = pose_of(d.placement, bone.model.grid);
    bone.chart = subject::make_chart(bone.model, bone.X_WB, *d.cavity);
    bone.plan = subject::plan_cavity(bone.model, bone.X_WB, *d.cavity, protocols::smallest_burr(d));
    bones.push_back(std::move(bone));
  }
  return bones;
}

std::string comment_on(const Outcome& o) {
  constexpr double kCubic = 1e9;  // [mm3/m3]
  return fmt::format(
      "{:.0f} % of the cavity; {:.1f} mm3 beyond; {:.1f} mm3 of vital structures; rough {:.2f} mm",
      100.0 * o.complete, kCubic * o.beyond, kCubic * o.injured, 1e3 * o.roughness);
}

std::vector<drilling::Rating> rate_session(const fs::path& file,
                                           const std::vector<RatedBone>& bones) {
  const record::SessionReader session(file);
  std::map<int, int> trials;
  for (const record::PassRow& pass : session.passes()) {
    if (!pass.practice && pass.phase == record::kDrillingPhase) {
      ++trials[pass.trial];
    }
  }
  std::vector<drilling::Rating> ratings;
  for (const auto& [trial, passes] : trials) {
    const RatedBone& bone = bones[static_cast<std::size_t>(trial - 1) % bones.size()];
    const Outcome outcome = outcome_of(bone.model, standing_after(session, bone.model, trial),
                                       bone.plan, bone.X_WB, bone.chart);
    const double rubric = rubric_score(outcome);
    const std::string name = file.filename().string();
    for (const RaterManner& rater : simulated_raters()) {
      const double score = given_score(rubric, rater, session.info().seed,
                                       fmt::format("{} procedure {}", name, trial));
      ratings.push_back({name, trial, rater.name, score, comment_on(outcome), true});
    }
  }
  return ratings;
}

}  // namespace

Outcome outcome_of(const bone::BoneModel& model, const std::vector<std::uint8_t>& standing,
                   const subject::CavityPlan& plan, const Eigen::Isometry3d& X_WB,
                   const DrillingChart& chart) {
  const double voxel = std::pow(model.grid.spacing, 3);
  drilling::PlanCount count{.planned = plan.planned};
  for (std::size_t at = 0; at < model.labels.size(); ++at) {
    if (model.labels[at] != 0 && standing[at] == 0) {
      count.add(plan.parts[at]);
    }
  }
  Outcome outcome;
  outcome.planned = voxel * static_cast<double>(count.planned);
  outcome.complete = count.share().value_or(0.0);
  outcome.beyond = voxel * static_cast<double>(count.beyond);
  outcome.injured = voxel * static_cast<double>(count.injured);
  const Roughness rough = roughness_of(chart, floor_of(model, standing, X_WB.inverse(), chart));
  outcome.roughness = rough.all;
  outcome.carved = rough.carved;
  return outcome;
}

double rubric_score(const Outcome& o) noexcept {
  constexpr double kCubicMillimetre = 1e-9;
  double score = 5.0;
  score -= 4.0 * std::max(0.0, 0.9 - o.complete);
  score -= o.planned > 0.0 ? 2.0 * o.beyond / o.planned : 0.0;
  if (o.injured > 0.0) {
    score -= 0.25 + 2.5 * (1.0 - std::exp(-o.injured / (60.0 * kCubicMillimetre)));
  }
  score -= 2.0 * std::max(0.0, o.carved / 1e-3 - 0.4);
  return std::max(drilling::kLowestScore, score);
}

std::vector<RaterManner> simulated_raters() {
  return {{"simulated-strict", -0.2, 0.35}, {"simulated-lenient", 0.3, 0.55}};
}

double given_score(double rubric, const RaterManner& rater, std::uint64_t seed,
                   const std::string& what) {
  RandomStream random(seed, fmt::format("{} rates {}", rater.name, what));
  const double score = rubric + rater.bias + rater.noise * random.normal();
  return std::clamp(std::round(score), drilling::kLowestScore, drilling::kHighestScore);
}

std::vector<drilling::Rating> simulate_ratings(const fs::path& folder, int threads) {
  const std::vector<fs::path> files = files_of(folder, Pilots::kLeftOut);
  const std::vector<RatedBone> bones = bones_of(record::SessionReader(files.front()));
  std::vector<std::vector<drilling::Rating>> by_file(files.size());
  in_groups(files.size(), 1, threads, [&] {
    return
        [&](std::size_t first, std::size_t) { by_file[first] = rate_session(files[first], bones); };
  });
  std::vector<drilling::Rating> ratings;
  for (const auto& own : by_file) {
    ratings.insert(ratings.end(), own.begin(), own.end());
  }
  return ratings;
}

}  // namespace haptrial::experiments
