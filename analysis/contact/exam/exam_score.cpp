#include "analysis/contact/exam/exam_score.h"

#include <algorithm>
#include <iterator>

namespace haptrial::evaluation {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using Vectors = std::vector<Vector3d>;

constexpr double kFelt = 0.2;            // [N]
constexpr double kShareOfTruth = 0.1;    // below it a force is lost
constexpr double kShareOfEnergy = 0.01;  // of what goes in and out
constexpr double kNoticed = 0.05;        // of the samples
constexpr double kShareOfMomentum = 0.05;
constexpr double kShareOfShape = 0.1;  // of the way of the vertices, or of a free body's size

Vectors forces_of(const std::vector<Answer>& answers) {
  Vectors forces;
  std::ranges::transform(answers, std::back_inserter(forces), &Answer::force);
  return forces;
}

Vectors torques_of(const std::vector<Answer>& answers) {
  Vectors torques;
  std::ranges::transform(answers, std::back_inserter(torques), &Answer::torque);
  return torques;
}

/// Energy that the hand is given on a step of its way [J]: the mean of both ends.
double given_on(const std::vector<Answer>& answers, const ExamCase& one, std::size_t i) {
  const Eigen::Isometry3d &from = one.tool[i], &to = one.tool[i + 1];
  const Answer &before = answers[i], &after = answers[i + 1];
  double given = 0.5 * (before.force + after.force).dot(to.translation() - from.translation());
  if (one.task.is_rigid()) {
    const Eigen::AngleAxisd turn(to.linear() * from.linear().transpose());
    given += 0.5 * turn.angle() * (before.torque + after.torque).dot(turn.axis());
  }
  return given;
}

struct Energy {
  double given{0.0};  // [J]
  double taken{0.0};  // from the tool, and given back later [J]
};

Energy energy_of(const std::vector<Answer>& answers, const ExamCase& one) {
  Energy energy;
  for (std::size_t i = 0; i + 1 < one.tool.size(); ++i) {
    const double given = given_on(answers, one, i);
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
  if (score.soft.inside_out > 0) {
    return ExamVerdict::kInsideOut;
  }
  if (score.soft.momentum_off > kShareOfMomentum) {
    return ExamVerdict::kLosesMomentum;
  }
  if (score.energy - score.true_energy > kShareOfEnergy * truth.taken) {
    return ExamVerdict::kGivesEnergy;
  }
  if (score.soft.root_mean_square > kShareOfShape * score.soft.moved ||
      score.soft.deformed > kShareOfShape) {
    return ExamVerdict::kMisshapen;
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
    case ExamVerdict::kInsideOut:
      return "inside out";
    case ExamVerdict::kLosesMomentum:
      return "loses momentum";
    case ExamVerdict::kGivesEnergy:
      return "gives energy";
    case ExamVerdict::kMisshapen:
      return "misshapen";
    case ExamVerdict::kNoticeable:
      return "noticeable";
    case ExamVerdict::kRight:
      return "right";
  }
  return "";
}

std::vector<ExamVerdict> verdicts_of(ExamKind kind) {
  using enum ExamVerdict;
  if (kind == ExamKind::kSoft) {
    return {kPopsThrough, kSticks,    kInsideOut,  kLosesMomentum,
            kGivesEnergy, kMisshapen, kNoticeable, kRight};
  }
  return {kPopsThrough, kSticks, kGivesEnergy, kNoticeable, kRight};
}

CaseScore score_case(const ExamCase& one, const std::vector<Answer>& answers) {
  CaseScore score;
  const Vectors right = forces_of(one.truth), force = forces_of(answers);
  score.force = force_error(right, force);
  if (one.task.is_rigid()) {
    score.torque = force_error(torques_of(one.truth), torques_of(answers));
  }
  score.bands = band_error(right, force, one.task.rate);
  score.noticeable = noticeable_error(right, force);
  Energy truth = energy_of(one.truth, one);
  score.energy = energy_of(answers, one).given;
  score.true_energy = truth.given;
  if (one.task.is_soft()) {
    score.soft = soft_score(one, answers);
    score.energy += score.soft.load_energy;
    truth.taken += score.soft.load_taken;
  }
  for (std::size_t i = 0; i < force.size(); ++i) {
    score.lost += is_lost(right[i], force[i]) ? 1 : 0;
    score.stuck += right[i].isZero(0.0) && force[i].norm() > kFelt ? 1 : 0;
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
    score.cases.push_back(score_case(exam[i], score.answers.cases[i].answer));
  }
  if (const fs::path failures = folder / "failures.csv"; fs::exists(failures)) {
    score.ridge = read_failures(failures);
    score.ridge->renderer = score.answers.renderer;
  }
  return score;
}

}  // namespace haptrial::evaluation
