#include "experiments/preview/fixed_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>

#include "core/base/counted.h"

namespace haptrial::experiments {
namespace {

struct Count {
  int fewest{0}, most{0}, all{0}, participants{0};
};

void add_to(Count& count, int trials) {
  count.fewest = count.participants == 0 ? trials : std::min(count.fewest, trials);
  count.most = std::max(count.most, trials);
  count.all += trials;
  ++count.participants;
}

}  // namespace

void add_fixed_plan(const protocols::Definition& definition,
                    const std::function<std::vector<protocols::PlannedTrial>(int)>& trials_of,
                    analysis::Document& document) {
  constexpr int kMostParticipants = 200;
  const int participants = std::min(definition.design.participants, kMostParticipants);
  std::map<std::string, Count> counts;
  for (int participant = 0; participant < participants; ++participant) {
    std::map<std::string, int> own;
    for (const protocols::PlannedTrial& trial : trials_of(participant)) {
      ++own[(trial.practice ? "practice: " : "") + trial.condition];
    }
    for (const auto& [condition, trials] : own) {
      add_to(counts[condition], trials);
    }
  }
  std::vector<std::vector<std::string>> rows;
  for (const auto& [condition, count] : counts) {
    rows.push_back({condition, fmt::format("{}", count.participants),
                    count.fewest == count.most ? fmt::format("{}", count.most)
                                               : fmt::format("{} to {}", count.fewest, count.most),
                    fmt::format("{}", count.all)});
  }
  document.heading("Trials of the study");
  document.paragraph(
      fmt::format("Counted in the first session of {}, by the code that plans sessions.",
                  counted(static_cast<std::size_t>(participants), "participant", "participants")));
  document.table({"condition", "participants", "trials of each", "trials in all"}, rows);
}

}  // namespace haptrial::experiments
