#include "analysis/contact/exam/exam_score.h"

#include <algorithm>
#include <cmath>

namespace haptrial::evaluation {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using Forces = std::vector<Vector3d>;

constexpr double kFelt = 0.2;            // [N]
constexpr double kShareOfTruth = 0.1;    // below it a force is lost
constexpr double kShareOfEnergy = 0.01;  // of what goes in and out
constexpr double kNoticed = 0.05;        // of the samples

/// Energy that a force gives to a tool on a step of its way [J]: the mean of both ends.
double given_on(const Forces& force, const Forces& tool, std::size_t i) {
  return 0.5 * (force[i] + force[i + 1]).dot(tool[i + 1] - tool[i]);
}

struct Energy {
  double given{0.0};  // [J]
  double taken{0.0};  // from the tool, and given back later [J]
};

Energy energy_of(const Forces& force, const Forces& tool) {
  Energy energy;
  for (std::size_t i = 0; i + 1 < tool.size(); ++i) {
    const double given = given_on(force, tool, i);
    energy.given += given;
    energy.taken += std::max(0.0, -given);
  }
  return energy;
}

bool is_lost(const Vector3d& truth, const Vector3d& force) {
  return truth.norm() > kFelt && force.dot(truth) < kShareOfTruth * truth.squaredNorm();
}

ExamVerdict verdict_of(const CaseScore& score, const Energy& truth) {
  if (score.lost > 0) {
    return ExamVerdict::kPopsThrough;
  }
  if (score.stuck > 0) {
    return ExamVerdict::kSticks;
  }
  if (score.energy - score.true_energy > kShareOfEnergy * truth.taken) {
    return ExamVerdict::kGivesEnergy;
  }
  return score.noticeable.beyond_low > kNoticed ? ExamVerdict::kNoticeable : ExamVerdict::kRight;
}

}  // namespace

const char* name_of(ExamVerdict verdict) {
  switch (verdict) {
    case ExamVerdict::kPopsThrough:
      return "pops through";
    case ExamVerdict::kSticks:
      return "sticks";
    case ExamVerdict::kGivesEnergy:
      return "gives energy";
    case ExamVerdict::kNoticeable:
      return "noticeable";
    case ExamVerdict::kRight:
      return "right";
  }
  return "";
}

CaseScore score_case(const ExamCase& one, const Forces& force) {
  CaseScore score;
  score.force = force_error(one.truth, force);
  score.bands = band_error(one.truth, force, one.task.rate);
  score.noticeable = noticeable_error(one.truth, force);
  const Energy truth = energy_of(one.truth, one.tool);
  score.energy = energy_of(force, one.tool).given;
  score.true_energy = truth.given;
  for (std::size_t i = 0; i < force.size(); ++i) {
    score.lost += is_lost(one.truth[i], force[i]) ? 1 : 0;
    score.stuck += one.truth[i].isZero(0.0) && force[i].norm() > kFelt ? 1 : 0;
  }
  score.verdict = verdict_of(score, truth);
  return score;
}

std::size_t ExamScore::count(ExamVerdict verdict) const {
  return static_cast<std::size_t>(std::ranges::count(cases, verdict, &CaseScore::verdict));
}

ExamScore score_answers(const fs::path& folder, const std::vector<ExamCase>& exam) {
  ExamScore score{read_answers(folder, exam), {}, {}};
  for (std::size_t i = 0; i < exam.size(); ++i) {
    score.cases.push_back(score_case(exam[i], score.answers.cases[i].force));
  }
  if (const fs::path failures = folder / "failures.csv"; fs::exists(failures)) {
    score.ridge = read_failures(failures);
    score.ridge->renderer = score.answers.renderer;
  }
  return score;
}

}  // namespace haptrial::evaluation
