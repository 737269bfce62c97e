#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/contact/demo_study/failure_map.h"
#include "analysis/contact/exam/candidate.h"
#include "analysis/contact/exam/exam_stability.h"

namespace haptrial::evaluation {

/// A tool that is led along a body, and what is right.
struct ExamCase {
  std::string name;  // "thin-plate-friction"
  ContactTask task;
  std::vector<Eigen::Isometry3d>
      tool;  // (n), the first one in the air, the last one the same; a point is not turned
  std::vector<Answer> truth;  // (n)
  // A soft body alone has these: the share of its forces that acts (n), and samples at which its
  // shape is asked, ascending; the truth has no shape of a body that nothing holds.
  std::vector<double> load{};
  std::vector<std::size_t> shape_samples{};
};

/// Writes the exam of a point as plain files: exam.json, README.md, LICENCE, and for each case its
/// body (.obj) and its path with the true forces (.csv). The bodies are exam_bodies(), each without
/// friction and with 0.3, at 500 N/m and 1 kHz. Nothing in it is random: every exam is the same.
/// @throws InputError when `folder` holds anything or cannot be made. Source: Morris 2006, §7.5.
void write_exam(const std::filesystem::path& folder);
/// Writes the exam of rigid tools, exam_tools(), likewise: 500 N/m, 0.3 N·m/rad, 1 kHz, torques.
void write_rigid_exam(const std::filesystem::path& folder);
/// Writes the exam of soft bodies, exam_softs() and free_block(), at 1 kHz: a body (.node, .ele), a
/// path with the true forces, and the true shapes at every 50th sample.
void write_soft_exam(const std::filesystem::path& folder);

/// @throws InputError for a file that is missing or does not hold what it should.
std::vector<ExamCase> read_exam(const std::filesystem::path& folder);

/// A renderer's answers to an exam, and what they cost on this computer.
struct ExamAnswers {
  std::string renderer;
  struct Case {
    std::vector<Answer> answer;                // (n)
    double preparation{0.0};                   // of the body [s]
    double median_tick{0.0}, worst_tick{0.0};  // with the way to a program and back [s]
  };
  std::vector<Case> cases{};               // as those of the exam
  std::vector<StabilityCell> stability{};  // of a point; empty: not known
  bool costs_known{true};
};

/// Leads the tool along every case. @param renderer  what the candidate is called
ExamAnswers sit_exam(Candidate& candidate, const std::string& renderer,
                     const std::vector<ExamCase>& exam);

/// Writes answers.json, CASE.csv with the forces of each case, of a soft body CASE-shape.csv, and
/// failures.csv and stability.csv if they are known.
/// @param ridges  none: no failures.csv
/// @throws InputError when `folder` holds anything or cannot be made.
void write_answers(const ExamAnswers& answers, const std::optional<FailureMap>& ridges,
                   const std::vector<ExamCase>& exam, const std::filesystem::path& folder);
/// Answers that this or another program wrote. Without answers.json the renderer is called as the
/// folder, and its costs are not known.
/// @throws InputError for a case that is missing or has more or fewer forces than its path, or
/// other shapes than are asked.
ExamAnswers read_answers(const std::filesystem::path& folder, const std::vector<ExamCase>& exam);

}  // namespace haptrial::evaluation
