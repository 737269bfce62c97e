#include <fmt/format.h>

#include "core/base/counted.h"
#include "core/base/whole_file.h"
#include "experiments/command/arguments.h"
#include "experiments/command/drilling/drilling_commands.h"
#include "experiments/studies/drilling/learn_limits.h"

namespace haptrial::experiments {

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

}  // namespace haptrial::experiments
