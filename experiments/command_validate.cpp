#include "experiments/commands.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "experiments/contact_margin.h"
#include "experiments/counted.h"
#include "experiments/experiment.h"
#include "experiments/loop_margin.h"
#include "experiments/session.h"
#include "experiments/warnings.h"

namespace haptrial::experiments {

namespace {

void print_bones(const BoneDefinition& d) {
  fmt::print("{}: {}, {} of at most {:.0f} s{}, {} Hz\n", d.name,
             counted(d.design.participants, "participant", "participants"),
             counted(d.design.trials, "procedure", "procedures"), d.drilling.time_limit,
             d.design.trials == 1 ? "" : " each", d.rate);
  for (const auto& bone : d.bones) {
    const auto filled = std::count_if(bone->labels.begin(), bone->labels.end(),
                                      [](std::uint8_t label) { return label != 0; });
    fmt::print("bone: {}, {} x {} x {} voxels of {:.3g} mm, {} of them filled\n", bone->name,
               bone->grid.size[0], bone->grid.size[1], bone->grid.size[2], 1e3 * bone->grid.spacing,
               filled);
  }
  std::vector<std::string> tools;
  for (const bone::ToolSpec& tool : d.simulator.tools) {
    tools.push_back(tool.name);
  }
  fmt::print("tools: {}\n", fmt::join(tools, ", "));
}

void print_margins(const Definition& d) {
  for (const auto& [name, gains] :
       {std::pair{"trajectory", d.guidance.trajectory}, {"plane", d.guidance.plane}}) {
    fmt::print("{}\n", describe(loop_margin(name, gains, d.guidance.loop)));
  }
}

}  // namespace

int validate(const std::string& file) {
  const Experiment experiment = load_experiment(file);
  fmt::print("{}: valid\n", file);
  if (experiment.bone) {
    print_bones(*experiment.bone);
    if (const auto margin = contact_margin(*experiment.bone)) {
      fmt::print("{}\n", describe(*margin));
    }
    print_warnings(experiment);
    return 0;
  }
  const Definition& d = *experiment.force;
  fmt::print("{}: {}, {} in {} of {}, {} {}, {} Hz\n", d.name,
             counted(d.design.participants, "participant", "participants"),
             counted(d.design.trials, "trial", "trials"),
             counted(d.design.blocks(), "block", "blocks"), d.design.repetitions,
             d.design.conditions.size() == 1 ? "condition" : "conditions",
             fmt::join(d.design.conditions, ", "), d.rate);
  fmt::print("about {:.0f} minutes per participant, breaks not counted\n",
             estimated_ticks(d, d.design.trials) / d.rate / 60.0);
  print_margins(d);
  print_warnings(experiment);
  return 0;
}

}  // namespace haptrial::experiments
