#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/contact/demo_study/failure_map.h"
#include "analysis/contact/evaluation/rendering_error.h"
#include "analysis/contact/exam/exam.h"
#include "analysis/contact/exam/soft_score.h"

namespace haptrial::evaluation {

/// A verdict says the worst that is wrong with the answers to a case; the worst stands first.
enum class ExamVerdict : std::uint8_t {
  kPopsThrough,    // no force, or one into the body, where there should be one
  kSticks,         // a force in the air
  kInsideOut,      // a tetrahedron of a soft body is turned inside out
  kLosesMomentum,  // of a free body by a twentieth, or its angular momentum: SoftScore
  kGivesEnergy,    // the hand, or a force, gains energy on the way there and back
  kMisshapen,      // vertices are off by more than a tenth of their way, or a free body's are by
                   // a tenth of its size, in the root mean square
  kNoticeable,     // off by more than 7 % of the force on more than a twentieth of the samples
  kRight
};
const char* name_of(ExamVerdict verdict);
/// Verdicts that an exam of a kind can have, the worst first.
std::vector<ExamVerdict> verdicts_of(ExamKind kind);

struct CaseScore {
  ForceError force;
  ForceError torque;  // likewise, of a rigid tool [N·m]
  BandError bands;
  NoticeableError noticeable;
  double energy{0.0};       // that the tool was given on the closed path [J]
  double true_energy{0.0};  // that it is given by the truth: none, or less with friction [J]
  std::size_t lost{0};      // ticks without a force, or with one into the body, of contact
  std::size_t stuck{0};     // ticks with a force in the air
  SoftScore soft;           // of a soft body
  ExamVerdict verdict{ExamVerdict::kRight};
};

/// Compares the answers to a case with the truth. Forces below 0.2 N count as none where popping
/// through and sticking are judged; energy counts from a hundredth of what the truth takes in.
/// @param answers  (n), as long as the path
CaseScore score_case(const ExamCase& one, const std::vector<Answer>& answers);

struct ExamScore {
  ExamAnswers answers;
  std::vector<CaseScore> cases;     // as those of the exam
  std::optional<FailureMap> ridge;  // failures.csv beside the answers

  std::size_t count(ExamVerdict verdict) const;
};

/// @throws InputError as read_answers() and read_failures()
ExamScore score_answers(const std::filesystem::path& folder, const std::vector<ExamCase>& exam);

/// A line for each renderer.
std::vector<std::string> score_lines(const std::vector<ExamScore>& scores);

/// Writes scores.csv, scores.json, a map of failures for each renderer that has one, and
/// report.html. All but the costs is the same on every computer.
/// @throws InputError when two renderers have one name but for marks and spaces, or `folder` holds
/// anything or cannot be made; RunError as draw_figures().
void write_scores(const std::vector<ExamScore>& scores, const std::vector<ExamCase>& exam,
                  const std::filesystem::path& folder);

}  // namespace haptrial::evaluation
