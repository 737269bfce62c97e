#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>

#include "analysis/contact/exam/exam.h"
#include "experiments/command/subcommand.h"

namespace haptrial::experiments {
namespace {

struct ExamMakeOptions {
  std::string folder;
};

int make_exam(const ExamMakeOptions& options) {
  evaluation::write_exam(options.folder);
  fmt::print("wrote {}: {} cases\n", options.folder, evaluation::read_exam(options.folder).size());
  return 0;
}

}  // namespace

void add_exam_make(CLI::App& exam, int& status) {
  CLI::App* sub =
      subcommand(exam, "make", "Write bodies, paths and the forces that are right",
                 "haptrial exam make out/exam",
                 {"exam.json, README.md, bodies and cases in FOLDER", "algorithms/exam.md"});
  auto& o = options_of<ExamMakeOptions>(*sub, status, make_exam);
  sub->add_option("FOLDER", o.folder, "New folder of the exam")->required();
}

}  // namespace haptrial::experiments
