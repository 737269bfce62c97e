#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>

#include "analysis/contact/exam/exam.h"
#include "experiments/command/subcommand.h"

namespace haptrial::experiments {
namespace {

struct ExamMakeOptions {
  std::string folder;
  bool rigid{false};
  bool soft{false};
};

int make_exam(const ExamMakeOptions& options) {
  if (options.rigid) {
    evaluation::write_rigid_exam(options.folder);
  } else if (options.soft) {
    evaluation::write_soft_exam(options.folder);
  } else {
    evaluation::write_exam(options.folder);
  }
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
  CLI::Option* rigid =
      sub->add_flag("--rigid", o.rigid, "Rigid tools with force and torque, in place of a point");
  sub->add_flag("--soft", o.soft, "Bodies that give way, in place of hard ones")->excludes(rigid);
}

}  // namespace haptrial::experiments
