#include "experiments/commands.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/definition.h"
#include "experiments/session.h"

namespace haptrial::experiments {

int validate(const std::string& file) {
  const Definition d = load_definition(file);
  fmt::print("{}: valid\n", file);
  fmt::print("{}: {} participants, {} trials in {} blocks of {}, conditions {}, {} Hz\n", d.name,
             d.design.participants, d.design.trials, d.design.blocks(), d.design.repetitions,
             fmt::join(d.design.conditions, ", "), d.rate);
  fmt::print("about {:.0f} minutes a participant without the break\n",
             estimated_ticks(d, d.design.trials) / d.rate / 60.0);
  return 0;
}

}  // namespace haptrial::experiments
