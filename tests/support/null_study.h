#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "analysis/bone_drilling/report/validity_table.h"
#include "core/base/file_text.h"
#include "core/base/random.h"
#include "experiments/studies/drilling/simulated_rater.h"
#include "experiments/study/study_run.h"
#include "protocols/bone_drilling/bone_protocol.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/bone_drilling/load_bones.h"

namespace haptrial::test {

/// A construct-validity study in which everybody has the same skill, made smaller: voxels of 1 mm,
/// burrs that remove eight times as much, a cavity that ends 13 mm higher, four seconds for it.
struct NullStudy {
  int people{15};       // simulated once, at least 15
  double seconds{4.0};  // of a procedure
  double skill{0.5};    // of everybody
  int runs{1};          // studies of 8 "experts" and 7 "novices", drawn from these people anew
  std::uint64_t seed{1};
  int jobs{2};
};

/// How many runs found a difference in the ratings, p < 0.05, one-tailed.
struct NullFigures {
  int pooled{0};                             // Student's t over procedures, as the source
  int means{0};                              // Welch's t over participants' means
  int mixed{0};                              // mixed model, participants as random intercepts
  std::vector<std::vector<double>> ratings;  // (people x procedures)
};

inline std::string replaced_line(std::string text, const std::string& begin,
                                 const std::string& line) {
  const std::size_t at = text.find("\n" + begin);
  if (at == std::string::npos) {
    throw std::invalid_argument("no line of the shipped study starts with " + begin);
  }
  return text.replace(at + 1, text.find('\n', at + 1) - at - 1, line);
}

/// The shipped study as NullStudy says.
inline std::string null_definition(const std::filesystem::path& shipped, const NullStudy& study) {
  std::string text = file_text(shipped);
  text = replaced_line(text, "participants =", fmt::format("participants = {}", study.people));
  text = replaced_line(text, "surgeons =", fmt::format("surgeons = {}", study.people - 2));
  text = replaced_line(text, "residents =", "residents = 1");
  text = replaced_line(text, "novices =", "novices = 1");
  text = replaced_line(text, "time_limit =", fmt::format("time_limit = {:.3f}", study.seconds));
  text = replaced_line(text, "seed =", "seed = 1\nspacing = 0.001");
  text = replaced_line(text, "removal_rate = 60", "removal_rate = 480.0");
  text = replaced_line(text, "removal_rate = 120", "removal_rate = 960.0");
  text = replaced_line(text, "offset =", "offset = [-0.015, 0.007, 0.001]");
  const std::size_t skills = text.find("[virtual_surgeons.skill]");
  const std::size_t end = text.find("\n\n", skills);
  const std::string same = fmt::format(
      "[virtual_surgeons.skill]\nsurgeons = {0:.3f}\nresidents = {0:.3f}\nnovices = {0:.3f}",
      study.skill);
  return text.replace(skills, end - skills, same);
}

/// @param folder  where the definition is written to
inline protocols::BoneDefinition null_experiment(const std::filesystem::path& shipped,
                                                 const std::filesystem::path& folder,
                                                 const NullStudy& study) {
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "null.toml") << null_definition(shipped, study);
  return protocols::load_bone_definition(folder / "null.toml");
}

/// (people x procedures) The people's sessions, simulated and rated like those of the whole study.
/// @param folder  new, for session files
inline std::vector<std::vector<double>> null_ratings(const protocols::BoneDefinition& d,
                                                     const std::filesystem::path& folder,
                                                     const NullStudy& study) {
  experiments::DryRun dry;
  dry.participants = study.people;
  dry.seed = study.seed;
  dry.jobs = study.jobs;
  dry.folder = folder;
  experiments::run_dry(protocols::bone_drilling(), d, dry);
  std::map<std::string, std::map<int, double>> sums;  // over the two raters
  for (const auto& rating : experiments::simulate_ratings(dry.folder, study.jobs)) {
    sums[rating.session][rating.procedure] += 0.5 * rating.score;
  }
  std::vector<std::vector<double>> ratings;
  for (const auto& [session, scores] : sums) {
    ratings.emplace_back();
    for (const auto& [procedure, score] : scores) {
      ratings.back().push_back(score);
    }
  }
  return ratings;
}

/// One study: the first 15 people of an order, of whom the first eight are "experts".
inline void count_run(const std::vector<std::vector<double>>& ratings,
                      const std::vector<std::size_t>& order, NullFigures& figures) {
  analysis::drilling::ValueTable table;
  for (std::size_t n = 0; n < 15; ++n) {
    double number = 1.0;
    for (const double score : ratings[order[n]]) {
      table.rows.push_back({score, n, "", n < 8, number++});
    }
  }
  const auto found = analysis::drilling::contrast(table, analysis::drilling::Expected::kHigher);
  figures.pooled += found.pooled && found.pooled->p < 0.05 ? 1 : 0;
  figures.means += found.means && found.means->p < 0.05 ? 1 : 0;
  figures.mixed += found.mixed_p && *found.mixed_p < 0.05 ? 1 : 0;
}

inline std::vector<std::size_t> in_order(std::size_t people) {
  std::vector<std::size_t> order(people);
  std::iota(order.begin(), order.end(), std::size_t{0});
  return order;
}

/// Draws the 15 people of a study.
inline void shuffle_first(std::vector<std::size_t>& order, RandomStream& random) {
  for (std::size_t n = 0; n < 15; ++n) {
    std::swap(order[n], order[n + random.below(order.size() - n)]);
  }
}

/// Simulates the people once, then draws studies from them: the same virtual people, raters and
/// tests as in the whole study.
/// @param d  of null_experiment()
inline NullFigures null_study(const protocols::BoneDefinition& d,
                              const std::filesystem::path& folder, const NullStudy& study) {
  NullFigures figures;
  figures.ratings = null_ratings(d, folder, study);
  RandomStream random(study.seed, "null studies");
  std::vector<std::size_t> order = in_order(figures.ratings.size());
  for (int run = 0; run < study.runs; ++run) {
    shuffle_first(order, random);
    count_run(figures.ratings, order, figures);
  }
  return figures;
}

}  // namespace haptrial::test
