#include <CLI/CLI.hpp>

#include "experiments/command/subcommand.h"

namespace haptrial::experiments {

void add_exam(CLI::App& app, int& status) {
  CLI::App* exam = subcommand(app, "exam", "Examine renderers of contact, of any program",
                              "haptrial exam make out/exam", {"", "algorithms/exam.md"});
  exam->require_subcommand(1);
  add_exam_make(*exam, status);
  add_exam_run(*exam, status);
  add_exam_score(*exam, status);
}

}  // namespace haptrial::experiments
