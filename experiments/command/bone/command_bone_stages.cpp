#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "analysis/files/staging.h"
#include "core/base/error.h"
#include "core/render/gl/image.h"
#include "experiments/command/arguments.h"
#include "experiments/command/subcommand.h"
#include "protocols/bone_drilling/display/stage_stills.h"
#include "protocols/bone_drilling/load_bones.h"

namespace haptrial::experiments {
namespace {

struct BoneStagesOptions {
  std::string definition;
  std::string out;
  int count{4};
};

int bone_stages(const BoneStagesOptions& options) {
  namespace fs = std::filesystem;
  const int count = checked_number("--count", options.count, 2, 20);
  if (fs::exists(options.out)) {
    throw InputError(fmt::format("{}: exists already; choose a new folder", options.out));
  }
  const protocols::BoneDefinition definition = protocols::load_bone_definition(options.definition);
  const std::vector<protocols::StageStill> stills = protocols::stage_stills(definition, count);
  const analysis::Staging staging(options.out);
  for (std::size_t stage = 0; stage < stills.size(); ++stage) {
    render::write_png(staging.path() / fmt::format("stage-{}.png", stage + 1), stills[stage].image);
  }
  staging.publish();
  fmt::print("{} stills: {}\n", stills.size(), options.out);
  return 0;
}

}  // namespace

void add_bone_stages(CLI::App& bone, int& status) {
  CLI::App* sub =
      subcommand(bone, "stages", "Draw stills of a cavity, stage by stage, for participants",
                 "haptrial bone stages construct_validity --out stills");
  auto& o = options_of<BoneStagesOptions>(*sub, status, bone_stages);
  sub->add_option("DEFINITION", o.definition, "Definition with a table [cavity] (.toml)")
      ->required();
  sub->add_option("--out", o.out, "New folder for the stills")->required();
  sub->add_option("--count", o.count,
                  with_default("Number of stills; the first shows the untouched bone", o.count));
}

}  // namespace haptrial::experiments
