#include "protocols/definition/schedule.h"

#include <fmt/format.h>

#include <numeric>
#include <set>

#include "core/base/definition/schema.h"
#include "core/base/random.h"

namespace haptrial::protocols {

bool read_break_until_ready(Table& table, int break_after) {
  table.describe({"break_until",
                  "What ends a break: its duration, or after that the participant or the "
                  "experimenter",
                  "time", false});
  if (!table.has("break_until")) {
    return false;
  }
  const bool ready = table.choice("break_until", {"time", "ready"}) == "ready";
  if (ready && break_after == 0) {
    table.reject("break_until",
                 "is \"ready\", but there are no breaks; add break_after, a number "
                 "of trials");
  }
  return ready;
}

void check_trials(Table& table, int trials, int repetitions, std::size_t conditions,
                  std::string_view whose) {
  const int group = repetitions * static_cast<int>(conditions);
  if (group > 0 && trials % group != 0) {
    table.reject("trials", fmt::format("{}", trials),
                 fmt::format("a multiple of {} ({} repetitions of {} conditions{})", group,
                             repetitions, conditions, whose));
  }
}

/// Notes contradictions between the keys of a design.
static void check_design(Table& table, Design& d) {
  check_trials(table, d.trials, d.repetitions, d.conditions.size());
  if (d.break_after >= d.trials) {
    table.reject("break_after", fmt::format("{}", d.break_after),
                 fmt::format("a whole number below the {} trials, or 0 for no break", d.trials));
  } else if (d.break_after % d.repetitions != 0) {
    table.reject("break_after", fmt::format("{}", d.break_after),
                 fmt::format("a multiple of the {} repetitions of a block", d.repetitions));
  }
  if (std::set<std::string>(d.conditions.begin(), d.conditions.end()).size() !=
      d.conditions.size()) {
    table.reject("conditions", "names a condition twice; name each condition once");
  }
}

const Schema<Design>& design_schema() {
  using D = Design;
  static const auto schema =
      Schema<D>()
          .integer("participants", &D::participants, 1, 10000, "Participants of the study")
          .required()
          .integer("sessions", &D::sessions, 1, 100,
                   "Sessions of each participant, on days of their own")
          .integer("trials", &D::trials, 1, 100000,
                   "Trials of each session; [design.session.N] may give session N another number")
          .required()
          .integer("repetitions", &D::repetitions, 1, 1000,
                   "Trials of a block, which share stimulus and condition")
          .required()
          .integer("break_after", &D::break_after, 0, 100000,
                   "Trials after which a break comes; 0: no breaks")
          .required()
          .number("break_duration", &D::break_duration, {0.0, 86400.0}, "s", "Duration of a break")
          .required()
          .integer("practice", &D::practice, 0, 100,
                   "Practice trials of each condition, which are not scored")
          .custom(
              "conditions", "Conditions of training",
              [](Table& table, const std::string& key, D& d) { d.conditions = table.texts(key); })
          .required()
          .check([](Table& table, D& d) {
            d.break_until_ready = read_break_until_ready(table, d.break_after);
            check_design(table, d);
          });
  return schema;
}

std::vector<std::vector<int>> williams_rows(int n) {
  // First row 0, n-1, 1, n-2, ...; the others add a constant modulo n.
  std::vector<int> first(n);
  for (int place = 0; place < n; ++place) {
    first[place] = place % 2 == 0 ? place / 2 : n - 1 - place / 2;
  }
  std::vector<std::vector<int>> rows;
  for (int shift = 0; shift < n; ++shift) {
    std::vector<int> row(n);
    for (int place = 0; place < n; ++place) {
      row[place] = (first[place] + shift) % n;
    }
    rows.push_back(row);
  }
  if (n % 2 == 1 && n > 1) {  // an odd number needs the mirror images as well
    for (int shift = 0; shift < n; ++shift) {
      rows.emplace_back(rows[shift].rbegin(), rows[shift].rend());
    }
  }
  return rows;
}

namespace {

std::vector<int> shuffled_rows(std::size_t count, std::uint64_t seed, int group) {
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  RandomStream stream(seed, fmt::format("order of group {}", group));
  for (std::size_t i = count - 1; i > 0; --i) {
    std::swap(order[i], order[stream.below(i + 1)]);
  }
  return order;
}

}  // namespace

std::vector<PlannedTrial> plan_trials(const Design& design, int participant,
                                      std::uint64_t study_seed, std::uint64_t person_seed) {
  const int n = static_cast<int>(design.conditions.size());
  const auto rows = williams_rows(n);
  std::vector<PlannedTrial> plan;
  for (const std::string& condition : design.conditions) {
    for (int trial = 1; trial <= design.practice; ++trial) {
      const std::uint64_t seed =
          derived_seed(person_seed, fmt::format("practice {} {}", condition, trial));
      const auto block = -static_cast<std::int32_t>(plan.size()) - 1;
      plan.push_back({trial, block, 1, condition, seed, true});
    }
  }
  const auto practice = static_cast<std::int32_t>(plan.size());
  for (int block = 0; block < design.blocks(); ++block) {
    const int group = block / n;
    const auto order = shuffled_rows(rows.size(), study_seed, group);
    const auto& row = rows[order[participant % static_cast<int>(rows.size())]];
    const std::string& condition = design.conditions[row[block % n]];
    const std::uint64_t seed = derived_seed(person_seed, fmt::format("block {}", block + 1));
    for (int repetition = 1; repetition <= design.repetitions; ++repetition) {
      plan.push_back({static_cast<std::int32_t>(plan.size()) - practice + 1, block + 1, repetition,
                      condition, seed, false});
    }
  }
  return plan;
}

}  // namespace haptrial::protocols
