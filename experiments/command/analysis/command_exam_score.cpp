#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "analysis/contact/exam/exam_score.h"
#include "experiments/command/subcommand.h"

namespace haptrial::experiments {
namespace {

struct ExamScoreOptions {
  std::string folder;
  std::vector<std::string> answers;
  std::string out;
};

int score_exam(const ExamScoreOptions& options) {
  const auto exam = evaluation::read_exam(options.folder);
  std::vector<evaluation::ExamScore> scores;
  for (const std::string& folder : options.answers) {
    scores.push_back(evaluation::score_answers(folder, exam));
  }
  if (!options.out.empty()) {
    evaluation::write_scores(scores, exam, options.out);
  }
  for (const std::string& line : evaluation::score_lines(scores)) {
    fmt::print("{}\n", line);
  }
  if (!options.out.empty()) {
    fmt::print("report: {}\n", (std::filesystem::path(options.out) / "report.html").string());
  }
  return 0;
}

}  // namespace

void add_exam_score(CLI::App& exam, int& status) {
  CLI::App* sub =
      subcommand(exam, "score", "Compare answers to an exam with the forces that are right",
                 "haptrial exam score out/exam out/answers-proxy --out out/scores",
                 {"scores.csv, scores.json, report.html and maps of ridges in the folder of --out",
                  "algorithms/exam.md"});
  auto& o = options_of<ExamScoreOptions>(*sub, status, score_exam);
  sub->add_option("EXAM", o.folder, "Folder of the exam")->required();
  sub->add_option("ANSWERS", o.answers, "Folders of answers, one for each renderer")->required();
  sub->add_option("--out", o.out, "New folder for the scores");
}

}  // namespace haptrial::experiments
