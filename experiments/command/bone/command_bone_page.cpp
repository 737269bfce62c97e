#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "core/base/error.h"
#include "experiments/command/arguments.h"
#include "experiments/command/subcommand.h"
#include "experiments/studies/drilling/trainee_pages.h"

namespace haptrial::experiments {
namespace {

struct BonePageOptions {
  std::vector<std::string> sessions;
  std::vector<std::string> experts;
  std::string study;
  std::string score;
  std::string phases;
  std::string checklist;
  std::string out;
  std::optional<int> trial;
  bool overwrite{false};
};

int bone_page(const BonePageOptions& options) {
  if (std::filesystem::path(options.out).extension() != ".html") {
    throw InputError(fmt::format("{}: is not a page by its name; allowed: .html", options.out));
  }
  TraineeRequest request;
  request.sessions.assign(options.sessions.begin(), options.sessions.end());
  request.experts.assign(options.experts.begin(), options.experts.end());
  request.study = options.study;
  request.score = options.score;
  request.phases = options.phases;
  request.checklist = options.checklist;
  request.out = options.out;
  request.overwrite = options.overwrite;
  if (options.trial) {
    request.trial = checked_number("--trial", *options.trial, 1, 1000);
  }
  for (const std::filesystem::path& file : write_trainee_pages(request)) {
    fmt::print("wrote       {}\n", file.string());
  }
  return 0;
}

}  // namespace

void add_bone_page(CLI::App& bone, int& status) {
  CLI::App* sub = subcommand(
      bone, "page", "Show a trainee what went well in drillings: a page for a browser",
      "haptrial bone page out/sessions/P05.h5 --study out/validity-001 --out P05.html",
      {"the page OUT, and of several procedures one page each beside it", "guide-bone.md"});
  auto& o = options_of<BonePageOptions>(*sub, status, bone_page);
  sub->add_option("SESSION", o.sessions, "Drilling sessions of one participant (.h5)")->required();
  sub->add_option("--out", o.out, "New page (.html)")->required();
  sub->add_option("--study", o.study,
                  "Folder of a study; participants of its expert groups are the experts");
  sub->add_option("--expert", o.experts,
                  "Session of an expert (.h5), shown beside on the same bone; may be repeated")
      ->allow_extra_args(false);
  sub->add_option("--score", o.score, "File of a score (haptrial bone score) to be applied");
  sub->add_option("--phases", o.phases,
                  "File of phases (haptrial bone phases) by which procedures are divided");
  sub->add_option("--checklist", o.checklist,
                  "Checklist (.toml) whose items are filled in by their measures");
  sub->add_option("--trial", o.trial, "Procedure of each session (default: all)");
  sub->add_flag("--overwrite", o.overwrite, "Overwrite existing pages");
}

}  // namespace haptrial::experiments
