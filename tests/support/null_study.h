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

#include "analysis/drilling/validity_table.h"
#include "core/base/random.h"
#include "experiments/bone_definition.h"
#include "experiments/simulated_rater.h"
#include "experiments/study_run.h"

namespace haptrial::test {

/// A construct-validity study in which everybody has the same skill, made smaller.
struct NullStudy {
  int people{30};        // simulated once, at least 15
  double seconds{40.0};  // of a procedure
  double skill{0.5};     // of everybody
  int runs{200};         // studies of 8 "experts" and 7 "novices", drawn from these people anew
  std::uint64_t seed{1};
  int jobs{2};
};

/// How many runs found a difference in the ratings, p < 0.05, one-tailed.
struct NullFigures {
  int pooled{0};                // Student's t over procedures, as the source
  int means{0};                 // Welch's t over participants' means
  int mixed{0};                 // mixed model, participants as random intercepts
  std::vector<double> ratings;  // (people) means
};

inline std::string replaced_line(std::string text, const std::string& begin,
                                 const std::string& line) {
  const std::size_t at = text.find("\n" + begin);
  if (at == std::string::npos) {
    throw std::invalid_argument("no line of the shipped study starts with " + begin);
  }
  return text.replace(at + 1, text.find('\n', at + 1) - at - 1, line);
}

/// The shipped study with its bone at 1 mm and one skill.
inline std::string null_definition(const std::filesystem::path& shipped, const NullStudy& study) {
  std::ifstream file(shipped);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  text = replaced_line(text, "participants =", fmt::format("participants = {}", study.people));
  text = replaced_line(text, "surgeons =", fmt::format("surgeons = {}", study.people - 2));
  text = replaced_line(text, "residents =", "residents = 1");
  text = replaced_line(text, "novices =", "novices = 1");
  text = replaced_line(text, "time_limit =", fmt::format("time_limit = {:.3f}", study.seconds));
  text = replaced_line(text, "seed =", "seed = 1\nspacing = 0.001");
  const std::size_t skills = text.find("[virtual_surgeons.skill]");
  const std::size_t end = text.find("\n\n", skills);
  const std::string same = fmt::format(
      "[virtual_surgeons.skill]\nsurgeons = {0:.3f}\nresidents = {0:.3f}\nnovices = {0:.3f}",
      study.skill);
  return text.replace(skills, end - skills, same);
}

/// Simulates the people's sessions and their ratings, then draws studies from them: the same
/// virtual people, raters and tests as in the whole study.
/// @param folder  new, for session files
inline NullFigures null_study(const std::filesystem::path& shipped,
                              const std::filesystem::path& folder, const NullStudy& study) {
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "null.toml") << null_definition(shipped, study);
  const experiments::BoneDefinition d = experiments::load_bone_definition(folder / "null.toml");
  experiments::DryRun dry;
  dry.participants = study.people;
  dry.seed = study.seed;
  dry.jobs = study.jobs;
  dry.folder = folder / "sessions";
  experiments::run_dry(d, dry);
  std::map<std::string, std::map<int, double>> ratings;  // sums over the two raters
  for (const auto& rating : experiments::simulate_ratings(dry.folder, study.jobs)) {
    ratings[rating.session][rating.procedure] += 0.5 * rating.score;
  }
  std::vector<std::map<int, double>> people;
  NullFigures figures;
  for (const auto& [session, scores] : ratings) {
    people.push_back(scores);
    double sum = 0.0;
    for (const auto& [procedure, score] : scores) {
      sum += score;
    }
    figures.ratings.push_back(sum / static_cast<double>(scores.size()));
  }
  RandomStream random(study.seed, "null studies");
  std::vector<std::size_t> order(people.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (int run = 0; run < study.runs; ++run) {
    analysis::drilling::ValueTable table;
    for (std::size_t n = 0; n < 15; ++n) {
      std::swap(order[n], order[n + random.below(order.size() - n)]);
      for (const auto& [procedure, score] : people[order[n]]) {
        table.rows.push_back({score, n, "", n < 8, static_cast<double>(procedure)});
      }
    }
    const auto found = analysis::drilling::contrast(table, analysis::drilling::Expected::kHigher);
    figures.pooled += found.pooled && found.pooled->p < 0.05 ? 1 : 0;
    figures.means += found.means && found.means->p < 0.05 ? 1 : 0;
    figures.mixed += found.mixed_p && *found.mixed_p < 0.05 ? 1 : 0;
  }
  return figures;
}

}  // namespace haptrial::test
