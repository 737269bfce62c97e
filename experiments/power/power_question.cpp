#include "experiments/power/power_question.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "core/base/definition/given_values.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/fnv.h"
#include "experiments/runner/version.h"
#include "experiments/studies/experiment.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

constexpr double kMostCells = 10'000.0;

/// Text of a number as TOML has it: whole numbers without a point, for keys that count.
std::string written(double value) {
  constexpr double kWhole = 1e15;
  return std::floor(value) == value && std::abs(value) < kWhole
             ? fmt::format("{}", static_cast<long long>(value))
             : fmt::format("{}", value);
}

void check_size(const PowerPlan& plan, const std::string& file_name) {
  double cells = 1.0;
  for (const VariedKey& key : plan.vary) {
    cells *= static_cast<double>(key.values.size());
  }
  if (cells > kMostCells) {
    throw InputError(fmt::format("{}: power.vary has {:.3g} cells; allowed: at most {:g}",
                                 file_name, cells, kMostCells));
  }
}

/// All combinations of levels, the last key fastest.
std::vector<std::vector<double>> crossed(const std::vector<std::vector<double>>& keys) {
  std::vector<std::vector<double>> all{{}};
  for (const std::vector<double>& values : keys) {
    std::vector<std::vector<double>> longer;
    for (const std::vector<double>& each : all) {
      for (const double value : values) {
        longer.push_back(each);
        longer.back().push_back(value);
      }
    }
    all = std::move(longer);
  }
  return all;
}

/// Sizes of groups with `all` participants in the proportion of those stated: whole ones by the
/// largest remainders.
std::vector<long> in_proportion(const std::vector<protocols::StudyGroup>& groups, long all) {
  long stated = 0;
  for (const protocols::StudyGroup& group : groups) {
    stated += group.participants;
  }
  std::vector<long> sizes, remainders;
  for (const protocols::StudyGroup& group : groups) {
    sizes.push_back(all * group.participants / stated);
    remainders.push_back(all * group.participants % stated);
  }
  for (long left = all - std::accumulate(sizes.begin(), sizes.end(), 0L); left > 0; --left) {
    const auto next = std::ranges::max_element(remainders) - remainders.begin();
    ++sizes[static_cast<std::size_t>(next)];
    remainders[static_cast<std::size_t>(next)] = -1;
  }
  return sizes;
}

void add_sizes(const std::vector<protocols::StudyGroup>& groups, std::vector<GivenKey>& given) {
  constexpr const char* kAll = "design.participants";
  const auto size_of = [&given](const std::string& key) -> std::optional<long> {
    const auto at = std::ranges::find(given, key, &GivenKey::key);
    return at != given.end() ? std::optional(std::stol(at->value)) : std::nullopt;
  };
  const std::optional<long> all = size_of(kAll);
  bool groups_vary = false;
  long sum = 0;
  for (const protocols::StudyGroup& group : groups) {
    const std::optional<long> own = size_of("groups." + group.name);
    groups_vary = groups_vary || own;
    sum += own.value_or(group.participants);
  }
  if (groups_vary && !all) {
    given.push_back({kAll, std::to_string(sum)});
  }
  if (all && !groups_vary && !groups.empty()) {
    const std::vector<long> sizes = in_proportion(groups, *all);
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      given.push_back({"groups." + groups[i].name, std::to_string(sizes[i])});
    }
  }
}

std::string name_of(const PowerPlan& plan, const std::vector<double>& levels) {
  std::string name;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    name += fmt::format("{}{} {}", i == 0 ? "" : ", ", plan.vary[i].key, levels[i]);
  }
  return name;
}

bool is_null(const PowerPlan& plan, const std::vector<double>& levels) {
  bool effects = false;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (plan.vary[i].none) {
      effects = true;
      if (levels[i] != *plan.vary[i].none) {
        return false;
      }
    }
  }
  return effects;
}

std::vector<QuestionCell> cells_of(const PowerPlan& plan) {
  std::vector<std::vector<double>> values, without;
  bool effects = false;
  for (const VariedKey& key : plan.vary) {
    values.push_back(key.values);
    without.push_back(key.none ? std::vector<double>{*key.none} : key.values);
    effects = effects || key.none.has_value();
  }
  std::vector<QuestionCell> cells;
  if (effects) {
    for (std::vector<double>& levels : crossed(without)) {
      cells.push_back({levels, true, false, name_of(plan, levels)});
    }
  }
  const std::size_t nulls = cells.size();
  for (std::vector<double>& levels : crossed(values)) {
    if (!is_null(plan, levels)) {
      cells.push_back({levels, false, false, name_of(plan, levels)});
    }
  }
  // Spread evenly over the cells with an effect.
  const std::size_t others = cells.size() - nulls;
  const auto checked = std::min(static_cast<std::size_t>(plan.checked_cells), others);
  for (std::size_t i = 0; i < checked; ++i) {
    cells[nulls + i * others / checked].checked = plan.depth == PowerDepth::kResponses;
  }
  return cells;
}

/// Throws InputError where a cell cannot be simulated.
void check_cell(const PowerQuestion& question, const QuestionCell& cell) {
  const std::vector<NamedText> parts = question.parts_of(cell);
  const Experiment experiment = parse_experiment(parts);
  const auto study_simulation = question.study->study_simulation(
      *experiment.definition, parts.back().file_name, question.plan.watch);
  if (!study_simulation->people_differ()) {
    throw InputError(fmt::format(
        "{}: virtual participants do not differ from each other, so a test over participants says "
        "nothing of people; give a parameter of theirs a spread above 0",
        question.definition_name));
  }
}

/// Every level of every key once, the others at their first: a value that the definition does not
/// allow is found before anything is simulated.
void check_levels(const PowerQuestion& question) {
  const PowerPlan& plan = question.plan;
  QuestionCell cell;
  for (const VariedKey& key : plan.vary) {
    cell.levels.push_back(key.values.front());
  }
  const auto check = [&] {
    cell.name = name_of(plan, cell.levels);
    try {
      check_cell(question, cell);
    } catch (const InputError& error) {
      throw InputError(
          fmt::format("{}{}{}", error.what(), cell.levels.empty() ? "" : "; with ", cell.name));
    }
  };
  check();
  for (std::size_t i = 0; i < plan.vary.size(); ++i) {
    std::vector<double> levels = plan.vary[i].values;
    if (plan.vary[i].none) {
      levels.push_back(*plan.vary[i].none);
    }
    for (std::size_t k = 1; k < levels.size(); ++k) {
      cell.levels[i] = levels[k];
      check();
    }
    cell.levels[i] = plan.vary[i].values.front();
  }
}

}  // namespace

std::string program_words() {
  return fmt::format("haptrial {} ({})", program_version(), program_commit());
}

std::string PowerQuestion::text_of(const QuestionCell& cell) const {
  std::string whole;
  for (const NamedText& part : parts_of(cell)) {
    whole += part.text;
  }
  return whole;
}

std::vector<NamedText> PowerQuestion::parts_of(const QuestionCell& cell) const {
  std::vector<GivenKey> asked, given;  // keys of [power], and those of the definition
  for (std::size_t i = 0; i < cell.levels.size(); ++i) {
    const bool own = plan.vary[i].key.starts_with("power.");
    (own ? asked : given).push_back({plan.vary[i].key, written(cell.levels[i])});
  }
  add_sizes(groups, given);
  std::vector<NamedText> all = parts;
  all.back().text = with_values(all.back().text, all.back().file_name, asked);
  all.front().text = with_values(all.front().text, all.front().file_name, given);
  return all;
}

PowerQuestion load_question(const fs::path& file) {
  Table root = Table::parse(file_text(file), file.string());
  if (!root.has("power")) {
    throw InputError(fmt::format(
        "{}: has no table [power]; give it watch and [[power.vary]] (docs/guide-power.md)",
        file.string()));
  }
  check_new_power(root);
  root.check();
  Table power = root.table("power");
  if (!power.has("definition")) {
    return parse_question({{root.source(), file.string()}}, file.parent_path());
  }
  const fs::path definition = file.parent_path() / power.text("definition");
  root.check();
  if (root.has("experiment")) {
    throw InputError(
        fmt::format("{}: power.definition names another definition; leave it out of a "
                    "definition",
                    file.string()));
  }
  const std::string text = file_text(definition);
  return parse_question({{text + (text.ends_with('\n') ? "" : "\n"), definition.string()},
                         {root.source(), file.string()}},
                        definition.parent_path());
}

PowerQuestion parse_question(const std::vector<NamedText>& parts, const fs::path& folder) {
  PowerQuestion question;
  question.parts = parts;
  for (const NamedText& part : parts) {
    question.text += part.text;
  }
  question.definition_name = parts.front().file_name;
  question.file_name = parts.back().file_name;
  question.folder = folder;
  const Experiment experiment = parse_experiment(parts);
  Table root = experiment.definition->root();
  question.plan = read_power_plan(root);
  question.study = experiment.study;
  if (experiment.definition->groups.front().participants > 0) {
    question.groups = experiment.definition->groups;
  }
  question.title = experiment.definition->name;
  question.fingerprint =
      fmt::format("{:016x}", Fnv1a().add(question.text).add(program_words()).value());
  check_size(question.plan, question.file_name);
  question.cells = cells_of(question.plan);
  check_levels(question);
  return question;
}

}  // namespace haptrial::experiments
