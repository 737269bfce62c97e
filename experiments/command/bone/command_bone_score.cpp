#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "core/base/counted.h"
#include "core/base/whole_file.h"
#include "experiments/command/subcommand.h"
#include "experiments/studies/drilling/learn_score.h"

namespace haptrial::experiments {
namespace {

struct BoneScoreOptions {
  std::string study;
  std::string out;
  bool overwrite{false};
};

int bone_score(const BoneScoreOptions& options) {
  const auto model = learn_study_score(options.study);
  WholeFile file(options.out, options.overwrite);
  file.write(analysis::drilling::score_model_text(model));
  file.finish();
  fmt::print("learned     from {} of {}{}\n",
             counted(model.procedures, "rated procedure", "rated procedures"),
             counted(model.participants, "participant", "participants"),
             model.simulated ? "; participants or raters were programs" : "");
  fmt::print("metrics     {}\n", model.metrics.size());
  fmt::print("left out    R = {:.2f}; 95 % of ratings within {:.2f} points of the score\n", model.r,
             model.half_width);
  fmt::print("wrote       {}\n", options.out);
  return 0;
}

}  // namespace

void add_bone_score(CLI::App& bone, int& status) {
  CLI::App* sub = subcommand(
      bone, "score", "Learn from a rated study how raters score drillings, for the next trainee",
      "haptrial bone score out/validity-001 --out score.json",
      {"the file OUT, which haptrial bone page --score and [feedback] of a definition name",
       "guide-bone.md"});
  auto& o = options_of<BoneScoreOptions>(*sub, status, bone_score);
  sub->add_option("STUDY", o.study, "Folder of a rated study of drillings")->required();
  sub->add_option("--out", o.out, "New file of the score (.json)")->required();
  sub->add_flag("--overwrite", o.overwrite, "Overwrite an existing file");
}

}  // namespace haptrial::experiments
