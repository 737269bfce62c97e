#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "core/base/counted.h"
#include "core/base/whole_file.h"
#include "experiments/command/subcommand.h"
#include "experiments/studies/drilling/learn_score.h"

namespace haptrial::experiments {
namespace {

struct BoneSafeOptions {
  std::vector<std::string> experts;
  std::string study;
  std::string out;
  bool overwrite{false};
};

int bone_safe(const BoneSafeOptions& options) {
  LimitsRequest request;
  request.experts.assign(options.experts.begin(), options.experts.end());
  request.study = options.study;
  const hint::SafeLimits limits = learn_limits(request);
  WholeFile file(options.out, options.overwrite);
  file.write(hint::safe_limits_text(limits));
  file.finish();
  fmt::print("learned     from {} of {}{}\n", counted(limits.procedures, "procedure", "procedures"),
             counted(limits.participants, "expert", "experts"),
             limits.simulated ? ", simulated ones" : "");
  for (const hint::SafeStructure& structure : limits.structures) {
    const hint::SafeInterval& nearest = structure.intervals.front();
    fmt::print("{:<28} {} of distance; at {:.0f} to {:.0f} mm at most {:.2f} N, {:.0f} mm/s\n",
               structure.name, counted(structure.intervals.size(), "interval", "intervals"),
               1e3 * nearest.from, 1e3 * nearest.to, nearest.force, 1e3 * nearest.speed);
  }
  fmt::print("wrote       {}\n", options.out);
  return 0;
}

}  // namespace

void add_bone_safe(CLI::App& bone, int& status) {
  CLI::App* sub = subcommand(
      bone, "safe", "Learn safe forces and speeds near structures from experts, for hints",
      "haptrial bone safe safe.toml --study out/validity-001",
      {"the file OUT, which [hints] of a definition names", "algorithms/live-hints.md"});
  auto& o = options_of<BoneSafeOptions>(*sub, status, bone_safe);
  sub->add_option("OUT", o.out, "New file of safe values (.toml)")->required();
  sub->add_option("--study", o.study,
                  "Folder of a study; participants of its expert groups are the experts");
  sub->add_option("--expert", o.experts, "Session of an expert (.h5); may be repeated")
      ->allow_extra_args(false);
  sub->add_flag("--overwrite", o.overwrite, "Overwrite an existing file");
}

}  // namespace haptrial::experiments
