// How many trials a second power simulates at the level of responses: sessions of shipped
// definitions, without the analysis of their answers. One core; seconds of the processor, the best
// of several rounds, so that other work on the machine counts little. Prints a table in Markdown.
//   bench_responses [SECONDS [DEFINITION]]
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string_view>
#include <utility>

#include "experiments/command/line/whole_command.h"
#include "experiments/studies/experiment.h"
#include "experiments/study/study_run.h"
#include "protocols/psychophysics/response_session.h"

namespace {

using namespace haptrial;

/// @returns what the processor has worked for this process [s]
double seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// @returns trials a second
double rate_of(const protocols::StudiedDefinition& definition, const std::string& met,
               double lasting) {
  const protocols::ResponseSession session(definition, met, {});
  std::size_t trials = 0;
  const double start = seconds();
  for (std::uint64_t seed = 1; seconds() - start < lasting; ++seed) {
    protocols::SessionPlace place;
    place.subject = experiments::participant_name(0);
    place.seed = seed;
    protocols::give_seeds(place);
    trials += session.answered(place).size();
  }
  return static_cast<double>(trials) / (seconds() - start);
}

}  // namespace

int main(int argc, char** argv) {
  experiments::add_shipped_studies();
  const double lasting = argc > 1 ? std::atof(argv[1]) : 3.0;
  const std::pair<const char*, const char*> studies[]{{"wall_detection", "$level"},
                                                      {"force_discrimination", "$force"},
                                                      {"stiffness_discrimination", "$stiffness"},
                                                      {"viscosity_magnitude", "$level"}};
  fmt::print("| definition | trials a second |\n| --- | --- |\n");
  for (const auto& [name, met] : studies) {
    if (argc > 2 && std::string_view(argv[2]) != name) {
      continue;
    }
    const auto file =
        std::filesystem::path(HAPTRIAL_SOURCE_DIR) / "experiments" / fmt::format("{}.toml", name);
    const experiments::Experiment experiment = experiments::load_experiment(file);
    const auto& definition =
        dynamic_cast<const protocols::StudiedDefinition&>(*experiment.definition);
    constexpr int kRounds = 5;
    double best = 0.0;
    for (int round = 0; round < kRounds; ++round) {
      best = std::max(best, rate_of(definition, met, lasting / kRounds));
    }
    fmt::print("| {} | {:.0f} |\n", name, best);
  }
  return 0;
}
