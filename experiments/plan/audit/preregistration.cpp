#include "experiments/plan/audit/preregistration.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "analysis/files/sha256.h"
#include "analysis/statistics/design/sequential_plan.h"
#include "analysis/statistics/tests/power.h"
#include "core/base/counted.h"
#include "core/base/definition/schema.h"
#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/base/whole_file.h"
#include "experiments/runner/version.h"
#include "experiments/studies/power_plan.h"
#include "protocols/definition/groups.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;

/// ", of share_wrong": the quantity of the planned tests and of the rule that ends the study, which
/// share it unless both state one. Empty: the first that is compared.
std::string stated_quantity(Table& analysis, bool of_rule) {
  const std::string tests = analysis.has("tests_of") ? analysis.text("tests_of") : "";
  std::string rule;
  if (analysis.has("sequential") && analysis.table("sequential").has("of")) {
    rule = analysis.table("sequential").text("of");
  }
  const std::string& name = (of_rule && !rule.empty()) || tests.empty() ? rule : tests;
  return name.empty() ? "" : ", of " + name;
}

/// Planned tests as the definition writes them, under the key that its protocol has.
std::vector<std::string> planned_tests(const protocols::Definition& definition) {
  Table root = definition.root();
  if (!root.has("analysis")) {
    return {};
  }
  Table analysis = root.table("analysis");
  for (const char* key : {"planned", "tests"}) {
    if (analysis.has(key)) {
      std::vector<std::string> tests = analysis.texts(key);
      for (std::string& test : tests) {
        test += stated_quantity(analysis, false);
      }
      return tests;
    }
  }
  return {};
}

/// The rule by which the study may end early, and the looks that it states.
void add_early_end(const protocols::Definition& definition, StudyPlan& plan) {
  Table root = definition.root();
  if (!root.has("analysis") || !root.table("analysis").has("sequential")) {
    return;
  }
  Table analysis = root.table("analysis");
  Table table = analysis.table("sequential");
  const auto rule = analysis::sequential_schema().read(table);
  const bool at_looks = rule.rule == analysis::StopRule::kGroupSequential;
  plan.ends_early = at_looks ? "group sequential" : kAtAnyTime;
  for (const double look : rule.looks) {
    plan.looks.push_back(static_cast<int>(look));
  }
  plan.stopping +=
      fmt::format("; or earlier, as soon as the rule \"{}\" of analysis.sequential decides{}",
                  plan.ends_early, stated_quantity(analysis, true));
}

/// When the data is analysed before the end.
std::string looks_of(const StudyPlan& plan) {
  if (plan.ends_early == kAtAnyTime) {
    return "the data may be analysed after every participant";
  }
  return plan.looks.empty() ? "the data is analysed at the end alone"
                            : fmt::format("the data is also analysed with {} participants",
                                          fmt::join(plan.looks, ", "));
}

std::vector<PlannedGroup> planned_groups(const protocols::Definition& definition) {
  if (definition.groups.size() < 2) {
    return {{"", definition.design.participants, definition.sessions()}};
  }
  std::vector<PlannedGroup> planned;
  for (const protocols::StudyGroup& group : definition.groups) {
    if (group.planned != group.participants) {
      throw InputError(fmt::format(
          "{}: groups does not have the {} participants of design.participants; a plan states the "
          "size of each group before the study",
          definition.file_name, definition.design.participants));
    }
    planned.push_back({group.name, group.participants, definition.sessions_of(group.name)});
  }
  return planned;
}

/// Sizes of the two samples of a two-sample test: the study's two groups, or the smallest two of
/// several, which have the least power; without groups, halves.
std::pair<int, int> samples_of(const StudyPlan& plan) {
  if (plan.groups.size() < 2) {
    return {plan.participants() / 2, plan.participants() / 2};
  }
  std::vector<int> sizes;
  for (const PlannedGroup& group : plan.groups) {
    sizes.push_back(group.participants);
  }
  if (sizes.size() > 2) {
    std::ranges::sort(sizes);
  }
  return {sizes[0], sizes[1]};
}

/// Power of the t test that [plan] states.
std::vector<std::string> power_of_t(const PlanTable& table, const StudyPlan& plan) {
  if (!table.effect) {
    return {};
  }
  analysis::TPlan test{analysis::TDesign::kOneSample, table.alpha, false};
  const char* name = "one-sample";
  int n = plan.participants();
  std::string people = counted(n, "participant", "participants");
  if (table.design == PlannedDesign::kPaired) {
    test.design = analysis::TDesign::kPaired;
    name = "paired";
  } else if (table.design == PlannedDesign::kTwoSample) {
    const auto [first, second] = samples_of(plan);
    test.design = analysis::TDesign::kTwoSample;
    test.ratio = static_cast<double>(second) / std::max(first, 1);
    name = "two-sample";
    n = first;
    people = fmt::format("{} and {} participants{}", first, second,
                         plan.groups.size() > 2 ? ", the smallest two groups," : "");
  }
  const auto power = analysis::t_power(test, n, std::abs(*table.effect));
  return {fmt::format(
      "a two-tailed {} t test at {:g} with {} finds a standardized effect of {:g} with {}", name,
      table.alpha, people, *table.effect,
      power ? fmt::format("a power of {:.3f}", *power)
            : "no known power, because " + power.because())};
}

std::vector<std::string> or_none(const std::vector<std::string>& texts, const char* none) {
  return texts.empty() ? std::vector<std::string>{none} : texts;
}

std::string sample_of(const StudyPlan& plan) {
  std::string groups;
  for (const PlannedGroup& group : plan.groups) {
    groups += group.name.empty() ? ""
                                 : fmt::format("{}{} {}", groups.empty() ? ": " : ", ", group.name,
                                               group.participants);
  }
  return fmt::format("{}{}; {} each", counted(plan.participants(), "participant", "participants"),
                     groups, counted(plan.sessions, "session", "sessions"));
}

}  // namespace

StudyPlan make_plan(const Experiment& experiment, const fs::path& simulation) {
  const protocols::Definition& d = *experiment.definition;
  Table root = d.root();
  const PlanTable table = read_plan_table(root);
  StudyPlan plan;
  plan.name = d.name;
  plan.made_utc = utc_now();
  plan.login = login_name();
  plan.program = fmt::format("haptrial {} ({})", program_version(), program_commit());
  plan.definition_name = d.file_name;
  plan.definition = d.text;
  plan.definition_sha256 = analysis::sha256_of(d.text);
  plan.scripts_sha256 =
      d.presenting_script().empty() ? "" : analysis::sha256_of(d.presenting_script());
  plan.groups = planned_groups(d);
  plan.sessions = d.sessions();
  plan.hypotheses = table.hypotheses;
  plan.tests = planned_tests(d);
  plan.exclusions = table.exclusions;
  plan.stopping =
      table.stopping.empty()
          ? fmt::format("when {} had every session",
                        counted(plan.participants(), "participant has", "participants have"))
          : table.stopping;
  for (const double look : table.looks) {
    if (look > plan.participants()) {
      throw InputError(fmt::format("{}: plan.looks has {}; allowed: up to the {} of the study",
                                   plan.definition_name, look,
                                   counted(plan.participants(), "participant", "participants")));
    }
    plan.looks.push_back(static_cast<int>(look));
  }
  add_early_end(d, plan);
  plan.retain_until = table.retain_until;
  plan.power = simulation.empty() ? power_of_t(table, plan)
                                  : simulated_power(simulation, plan.name, plan.participants());
  if (!plan.power.empty() && !plan.ends_early.empty()) {
    plan.power.push_back(
        fmt::format("this is of the planned test with every participant; the rule \"{}\" of "
                    "analysis.sequential decides, and its power is another, which is not stated",
                    plan.ends_early));
  }
  return plan;
}

analysis::Document preregistration(const StudyPlan& plan,
                                   const std::vector<std::string>& description) {
  analysis::Document page;
  page.title = "Plan of " + plan.name;
  page.subtitle = fmt::format("Made at {} by {} with {}, before the sessions that name it.",
                              plan.made_utc, plan.login, plan.program);
  page.heading("Hypotheses");
  page.points(or_none(plan.hypotheses, "none is stated: what the tests find is exploratory"));
  page.heading("Planned tests");
  page.points(or_none(plan.tests, "those that the analysis of the definition makes by itself"));
  page.heading("Participants and their number");
  page.points({sample_of(plan)});
  page.points(or_none(plan.power, "the power is not stated"));
  page.heading("End and analyses before it");
  page.points({"data collection ends: " + plan.stopping, looks_of(plan)});
  page.heading("Exclusions");
  page.points(or_none(plan.exclusions, "nobody is excluded"));
  page.paragraph(
      "Trials that the experimenter marks are left out only if analysis.exclude_marked of the "
      "definition says so.");
  page.heading("Procedure");
  page.points(description);
  page.heading("Data");
  page.points({plan.retain_until.empty() ? std::string("how long the data is kept is not stated")
                                         : "the data is kept until " + plan.retain_until});
  page.heading("Digests");
  page.table({"of", "SHA-256"}, {{"this plan, as a file", plan.sha256},
                                 {"the definition", plan.definition_sha256},
                                 {"script of levels beside it",
                                  plan.scripts_sha256.empty() ? "none" : plan.scripts_sha256}});
  page.heading("Definition");
  page.source(plan.definition_name, plan.definition);
  return page;
}

bool write_plan(const StudyPlan& plan, const fs::path& file,
                const std::vector<std::string>& description) {
  if (fs::exists(file)) {
    const StudyPlan there = read_study_plan(file);
    const std::vector<std::string> changed = plan_differences(there, plan);
    if (!changed.empty()) {
      throw InputError(fmt::format(
          "{}: is another plan, made at {}, and is never changed: {}; name another folder with "
          "--out",
          file.string(), there.made_utc, fmt::join(changed, "; ")));
    }
    return false;
  }
  if (!plan.retain_until.empty() && plan.retain_until < plan.made_utc.substr(0, 10)) {
    throw InputError(
        fmt::format("{}: plan.retain_until is {}, which is over; allowed: a date from today on",
                    plan.definition_name, plan.retain_until));
  }
  WholeFile whole(file);
  whole.write(plan_json(plan));
  whole.finish();
  const analysis::Document page = preregistration(read_study_plan(file), description);
  fs::path document = file;
  write_whole(document.replace_extension(".html"), analysis::to_html(page));
  write_whole(document.replace_extension(".md"), analysis::to_markdown(page));
  return true;
}

}  // namespace haptrial::experiments
