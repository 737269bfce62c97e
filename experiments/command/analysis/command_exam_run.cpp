#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/contact/exam/exam.h"
#include "analysis/contact/exam/exam_map.h"
#include "analysis/contact/exam/own_candidate.h"
#include "analysis/contact/exam/program_renderer.h"
#include "core/base/error.h"
#include "experiments/command/program_words.h"
#include "experiments/command/subcommand.h"
#include "experiments/control/signals.h"

namespace haptrial::experiments {
namespace {

struct ExamRunOptions {
  std::string folder;
  std::string renderer;
  std::vector<std::string> program;
  std::string name;
  std::string out;
};

std::unique_ptr<evaluation::Candidate> candidate_of(const ExamRunOptions& options,
                                                    evaluation::ExamKind exam) {
  if (options.renderer.empty() == options.program.empty()) {
    throw InputError("exam run needs either RENDERER or --program");
  }
  if (options.program.empty()) {
    return evaluation::own_candidate(options.renderer, exam);
  }
  return std::make_unique<evaluation::ProgramRenderer>(options.program,
                                                       [] { return !interrupted(); });
}

std::string name_of(const ExamRunOptions& options) {
  if (!options.name.empty()) {
    return options.name;
  }
  return options.program.empty() ? options.renderer : options.program.back();
}

int run_exam(const ExamRunOptions& options) {
  const auto exam = evaluation::read_exam(options.folder);
  const evaluation::ExamKind kind = exam.front().task.kind();
  std::optional<InterruptWatch> watch;
  if (!options.program.empty()) {
    watch.emplace();  // a program has a process group of its own, which no signal reaches
  }
  const auto candidate = candidate_of(options, kind);
  const std::string name = name_of(options);
  evaluation::ExamAnswers answers = evaluation::sit_exam(*candidate, name, exam);
  std::optional<evaluation::FailureMap> ridges;
  if (kind == evaluation::ExamKind::kPoint) {
    ridges = evaluation::failure_map_of(*candidate, name);
    answers.stability = evaluation::stability_of(*candidate);
  }
  evaluation::write_answers(answers, ridges, exam, options.out);
  fmt::print("wrote {}: {} cases{}\n", options.out, exam.size(),
             ridges ? ", a map of ridges and one of stability" : "");
  return 0;
}

}  // namespace

void add_exam_run(CLI::App& exam, int& status) {
  CLI::App* sub = subcommand(
      exam, "run", "Lead a tool along the bodies of an exam under a renderer",
      "haptrial exam run out/exam proxy --out out/answers-proxy",
      {"answers.json, a table of forces for each case (and of shapes of soft bodies), and "
       "failures.csv and stability.csv of a point in the folder of --out",
       "algorithms/exam.md"});
  auto& o = options_of<ExamRunOptions>(*sub, status, run_exam);
  sub->add_option("EXAM", o.folder, "Folder of the exam")->required();
  sub->add_option(
      "RENDERER", o.renderer,
      "Renderer of this program: proxy, penalty, voxel or distance-field; rigid-tool in "
      "an exam of rigid tools; springs, implicit or linear-elements in one of soft bodies");
  sub->add_option(kProgramOption, o.program,
                  "Another program and its arguments, which answers lines on its standard input "
                  "(to the end of the line)")
      ->expected(1, 100)
      ->delimiter(kProgramSeparator);
  sub->add_option("--name", o.name,
                  "Name of the renderer (default: RENDERER, or the last argument of the program)");
  sub->add_option("--out", o.out, "New folder of the answers")->required();
}

}  // namespace haptrial::experiments
