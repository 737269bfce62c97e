#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <system_error>

#include "analysis/bone_drilling/phases/phase_file.h"
#include "core/base/counted.h"
#include "core/base/error.h"
#include "core/base/whole_file.h"
#include "experiments/command/arguments.h"
#include "experiments/command/subcommand.h"
#include "experiments/studies/drilling/learn_phases.h"

namespace haptrial::experiments {
namespace {

struct BonePhasesOptions {
  std::string study;
  std::string labels;
  std::optional<int> number;
  std::string out;
  std::optional<int> jobs;
  bool overwrite{false};
};

void print_accuracy(const analysis::Defined<analysis::drilling::PhaseAccuracy>& accuracy) {
  if (!accuracy) {
    fmt::print("left out    not held against labels: {}\n", accuracy.because());
    return;
  }
  fmt::print(
      "left out    {:.0f} % of the time recognised in participants left out, {:.0f} % by always "
      "naming the longest phase; kappa {:.2f}\n",
      100.0 * accuracy->right(), 100.0 * accuracy->chance(), accuracy->kappa());
}

int bone_phases(const BonePhasesOptions& options) {
  constexpr int kMostPhases = 20;
  if (options.number) {
    checked_number("--number", *options.number, 2, kMostPhases);
  }
  if (options.number && !options.labels.empty()) {
    throw InputError("--number finds phases without labels; leave it or --labels out");
  }
  // analyze would overwrite what somebody corrected there.
  std::error_code unknown;
  if (std::filesystem::equivalent(options.labels,
                                  std::filesystem::path(options.study) / "phases.csv", unknown)) {
    throw InputError(options.labels +
                     ": haptrial analyze writes this file anew, without corrections; give a copy "
                     "under another name");
  }
  const std::filesystem::path out = options.out.empty()
                                        ? std::filesystem::path(options.study) / kPhasesFile
                                        : std::filesystem::path(options.out);
  WholeFile file(out, options.overwrite);
  const LearnedPhases learned = learn_study_phases(
      {options.study, options.labels, options.number, checked_jobs(options.jobs)});
  file.write(analysis::drilling::phase_model_text(learned.model));
  file.finish();
  const auto& model = learned.model;
  fmt::print("learned     from {} of {}{}\n", counted(model.procedures, "procedure", "procedures"),
             counted(model.participants, "participant", "participants"),
             model.simulated ? "; participants were programs" : "");
  fmt::print("phases      {}\n", fmt::join(model.phases, ", "));
  if (model.labelled) {
    fmt::print("labelled    {:.0f} % of the actions of labelled procedures\n",
               100.0 * learned.labelled);
    print_accuracy(learned.accuracy);
  }
  fmt::print("wrote       {}\n", out.string());
  return 0;
}

}  // namespace

void add_bone_phases(CLI::App& bone, int& status) {
  CLI::App* sub = subcommand(
      bone, "phases", "Learn from a study how drillings divide into phases",
      "haptrial bone phases out/validity-001 --labels phases.csv",
      {"the file OUT, by which haptrial analyze, haptrial bone page --phases and [feedback] of a "
       "definition divide procedures",
       "guide-bone.md"});
  auto& o = options_of<BonePhasesOptions>(*sub, status, bone_phases);
  sub->add_option("STUDY", o.study, "Folder of drilling sessions")->required();
  sub->add_option("--labels", o.labels,
                  "Table of labelled phases (.csv): session, procedure, phase, start_s, end_s "
                  "(default: what virtual surgeons worked on)");
  sub->add_option("--number", o.number, "Number of phases to find without labels");
  sub->add_option("--out", o.out, "New file of the phases (default: STUDY/phases.json)");
  sub->add_option("--jobs", o.jobs, kJobsHelp);
  sub->add_flag("--overwrite", o.overwrite, "Overwrite an existing file");
}

}  // namespace haptrial::experiments
