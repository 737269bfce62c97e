#include "analysis/psychophysics/fit/trials_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <stdexcept>
#include <utility>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/base/nearest.h"

namespace haptrial::analysis::trials {
namespace {

using psychometric::Scale;

constexpr std::array<std::pair<AnalysisKind, const char*>, 7> kKinds{
    {{AnalysisKind::kPsychometric, "psychometric"},
     {AnalysisKind::kDetection, "detection"},
     {AnalysisKind::kIdentification, "identification"},
     {AnalysisKind::kMagnitude, "magnitude"},
     {AnalysisKind::kAdjustment, "adjustment"},
     {AnalysisKind::kReaching, "reaching"},
     {AnalysisKind::kNone, "none"}}};
constexpr std::array<std::pair<Scale, const char*>, 4> kScales{{{Scale::kLinear, "linear"},
                                                                {Scale::kLog10, "log10"},
                                                                {Scale::kNaturalLog, "ln"},
                                                                {Scale::kDecibel, "decibel"}}};
constexpr double kMostGuess = 0.9, kMostLapse = 0.49;

template <class Value, std::size_t N>
Value chosen(Table& table, const char* key, const std::array<std::pair<Value, const char*>, N>& of,
             Value otherwise) {
  if (!table.has(key)) {
    return otherwise;
  }
  std::vector<std::string> words;
  for (const auto& each : of) {
    words.emplace_back(each.second);
  }
  const std::string word = table.choice(key, words);
  const auto at =
      std::find_if(of.begin(), of.end(), [&](const auto& e) { return word == e.second; });
  return at == of.end() ? otherwise : at->first;
}

std::string text_or(Table& table, const char* key) {
  return table.has(key) ? table.text(key) : std::string();
}

void read_by(Table& table, const PlanDefaults& defaults, TrialsPlan& plan) {
  const bool stated = plan.kind == AnalysisKind::kDetection ||
                      plan.kind == AnalysisKind::kIdentification ||
                      plan.kind == AnalysisKind::kReaching;
  plan.by = stated ? std::vector<std::string>{} : defaults.factors;
  if (!table.has("by")) {
    return;
  }
  plan.by = table.texts("by");
  std::vector<std::string> known = defaults.factors;
  known.insert(known.end(), defaults.names.begin(), defaults.names.end());
  for (const std::string& name : plan.by) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      table.reject("by", fmt::format("an array with \"{}\"", name),
                   fmt::format("{}", fmt::join(known, ", ")));
    }
  }
}

void read_stimulus(Table& table, const PlanDefaults& defaults, TrialsPlan& plan) {
  plan.choices = defaults.choices;
  plan.stimulus = defaults.factors.empty() ? "" : defaults.factors.front();
  if (table.has("stimulus")) {
    plan.stimulus = table.text("stimulus");
  }
  const bool known = std::find(defaults.factors.begin(), defaults.factors.end(), plan.stimulus) !=
                         defaults.factors.end() ||
                     std::find(defaults.names.begin(), defaults.names.end(), plan.stimulus) !=
                         defaults.names.end();
  if (!known) {
    table.reject("stimulus", fmt::format("\"{}\"", plan.stimulus),
                 "the factor that says what was presented");
  }
  if (plan.choices.empty()) {
    table.reject("kind", "\"identification\"", "another kind where the response has no choices");
  }
}

std::string short_number(const std::string& side) {
  double number = 0.0;
  const char* end = side.data() + side.size();
  const auto [rest, problem] = std::from_chars(side.data(), end, number);
  return problem == std::errc() && rest == end ? fmt::format("{}", number) : side;
}

/// The sides that a planned test may compare: levels of one factor of `by`, or combinations of all;
/// empty if the definition does not state some level.
std::vector<std::string> stated_sides(const std::vector<std::string>& by,
                                      const StatedLevels& stated) {
  std::vector<std::string> sides, combinations{""};
  for (const std::string& name : by) {
    const auto levels = stated.find(name);
    if (levels == stated.end()) {
      return {};
    }
    sides.insert(sides.end(), levels->second.begin(), levels->second.end());
    std::vector<std::string> longer;
    for (const std::string& before : combinations) {
      for (const std::string& level : levels->second) {
        longer.push_back(before.empty() ? level : before + ", " + level);
      }
    }
    combinations = std::move(longer);
  }
  if (by.size() > 1) {
    sides.insert(sides.end(), combinations.begin(), combinations.end());
  }
  return sides;
}

void check_side(Table& table, const std::string& side, const std::vector<std::string>& known) {
  if (std::ranges::find(known, side) == known.end()) {
    const std::string hint = did_you_mean(side, known);
    table.reject("tests", fmt::format("names '{}', which is no level of the factors in `by`{} "
                                      "allowed: '{}'",
                                      side, hint.empty() ? ";" : hint, fmt::join(known, "', '")));
  }
}

void read_tests(Table& table, const PlanDefaults& defaults, TrialsPlan& plan) {
  if (!table.has("tests")) {
    return;
  }
  constexpr std::string_view kWhere = "tests ";
  try {
    plan.plan = parse_analysis_plan(table.texts("tests"), "", "tests");
  } catch (const InputError& error) {
    table.reject("tests", std::string_view(error.what()).substr(kWhere.size()));
  }
  if (plan.plan.tests.empty()) {
    return;
  }
  if (plan.kind == AnalysisKind::kNone) {
    table.reject("tests", "compares conditions, but `kind` is \"none\"; state what is analysed");
  } else if (plan.by.empty()) {
    table.reject("tests", "compares conditions, but there are none; state the factors in `by`");
  }
  const std::vector<std::string> known = stated_sides(plan.by, defaults.levels);
  for (PlannedTest& test : plan.plan.tests) {
    test = with_short_numbers(std::move(test));
    if (!known.empty()) {
      check_side(table, test.a, known);
      check_side(table, test.b, known);
    }
  }
}

/// A procedure learns from answers that get rarer as the level rises, or more frequent.
void match_direction(Table& table, bool falls, TrialsPlan& plan) {
  if (plan.function.falling == falls) {
    return;
  }
  if (!table.has("function")) {
    plan.function_name = "neg_" + plan.function_name;
    plan.function.falling = falls;
  } else if (falls) {
    table.reject("function", fmt::format("\"{}\", which rises", plan.function_name),
                 fmt::format("\"neg_{}\", which falls as the procedure's right answers do",
                             plan.function_name));
  } else {
    table.reject("function", fmt::format("\"{}\", which falls", plan.function_name),
                 "a name without neg_, as the procedure's answers 1 rise with the level");
  }
}

void read_function(Table& table, const PlanDefaults& defaults, TrialsPlan& plan) {
  plan.function.axis = defaults.axis;
  if (table.has("function")) {
    plan.function_name = table.text("function");
  }
  try {
    psychometric::set_sigmoid(plan.function, plan.function_name, Scale::kNaturalLog);
  } catch (const std::invalid_argument& error) {
    table.reject("function", fmt::format("cannot be read: {}", error.what()));
  }
  if (defaults.falls && plan.yes.empty() && plan.question.empty()) {
    match_direction(table, *defaults.falls, plan);
  }
  plan.function.axis.scale = chosen(table, "scale", kScales, plan.function.axis.scale);
  if (table.has("origin")) {
    plan.function.axis.origin = table.number("origin", {}, plan.function.axis.unit);
  }
}

void read_guess(Table& table, const PlanDefaults& defaults, TrialsPlan& plan) {
  plan.guess_free = !defaults.guess.has_value();
  plan.function.guess = defaults.guess.value_or(0.0);
  if (table.has_text("guess")) {
    const std::string word = table.choice("guess", {"free", "lapse"});
    plan.guess_is_lapse = word == "lapse";
    plan.guess_free = word == "free";
    plan.function.guess = 0.0;
  } else if (table.has("guess")) {
    plan.function.guess = table.number("guess", {0.0, kMostGuess}, "");
    plan.guess_free = false;
  }
}

void read_lapse(Table& table, TrialsPlan& plan) {
  if (plan.guess_is_lapse) {
    plan.lapse = {};  // it counts on both sides
  }
  if (table.is_table("lapse")) {
    Table lapse = table.table("lapse");
    const bool free = !lapse.has("free") || lapse.boolean("free");
    plan.lapse.high =
        lapse.has("at_most") ? lapse.number("at_most", {0.0, kMostLapse}, "") : plan.lapse.high;
    plan.lapse.low = free ? 0.0 : plan.lapse.high;
  } else if (table.has("lapse")) {
    plan.lapse.low = plan.lapse.high = table.number("lapse", {0.0, kMostLapse}, "");
  }
}

void read_threshold(Table& table, TrialsPlan& plan) {
  const double guess = plan.guess_free ? 0.0 : plan.function.guess;
  plan.threshold_at = 0.5 * (1.0 + guess);
  if (table.has("threshold_at")) {
    plan.threshold_at = table.number("threshold_at", {0.0, 1.0}, "");
    if (!(plan.threshold_at > guess && plan.threshold_at < 1.0)) {
      table.reject("threshold_at", fmt::format("{}", plan.threshold_at),
                   fmt::format("a number above {} and below 1", guess));
      plan.threshold_at = 0.5 * (1.0 + guess);
    }
  }
  plan.function.share = (plan.threshold_at - guess) / (1.0 - guess);
  if (table.has("reference")) {
    plan.reference = table.number("reference", kPositive, plan.function.axis.unit);
  }
}

void read_psychometric(Table& table, const PlanDefaults& defaults, TrialsPlan& plan) {
  read_function(table, defaults, plan);
  read_guess(table, defaults, plan);
  read_lapse(table, plan);
  read_threshold(table, plan);
  if (table.has("bayesian")) {
    plan.bayesian = table.boolean("bayesian");
  }
  if (table.has("resamples")) {
    plan.resamples = static_cast<std::size_t>(table.integer("resamples", 0, 100'000));
  }
  plan.cues =
      read_cue_plan(table, defaults.cues, plan.by, plan.guess_free ? 0.0 : plan.function.guess);
}

}  // namespace

const char* name_of(AnalysisKind kind) {
  return std::find_if(kKinds.begin(), kKinds.end(), [&](const auto& e) { return e.first == kind; })
      ->second;
}

PlannedTest with_short_numbers(PlannedTest test) {
  test.a = short_number(test.a);
  test.b = short_number(test.b);
  return test;
}

TrialsPlan read_trials_plan(Table& root, const PlanDefaults& defaults) {
  TrialsPlan plan;
  plan.kind = defaults.kind;
  const bool detects = plan.kind == AnalysisKind::kDetection;
  plan.by = detects ? std::vector<std::string>{} : defaults.factors;
  plan.rating = detects ? defaults.rating : "";
  plan.functions = plan.kind == AnalysisKind::kPsychometric;
  plan.guess_free = !defaults.guess.has_value();
  plan.function.guess = defaults.guess.value_or(0.0);
  plan.function.axis = defaults.axis;
  if (!root.has("analysis")) {
    plan.threshold_at = 0.5 * (1.0 + plan.function.guess);
    return plan;
  }
  Table table = root.table("analysis");
  plan.kind = chosen(table, "kind", kKinds, defaults.kind);
  if (plan.kind == AnalysisKind::kReaching) {
    plan.functions = false;
    plan.reaching = read_reaching_plan(table, defaults.reaching);
    read_by(table, defaults, plan);
    read_tests(table, defaults, plan);
    return plan;
  }
  read_by(table, defaults, plan);
  read_tests(table, defaults, plan);
  plan.question = text_or(table, "question");
  plan.yes = text_or(table, "yes");
  plan.level = text_or(table, "level");
  plan.rating = "";
  if (plan.kind == AnalysisKind::kDetection || plan.kind == AnalysisKind::kIdentification) {
    plan.rating = table.has("rating") ? table.text("rating") : defaults.rating;
  }
  if (plan.kind == AnalysisKind::kIdentification) {
    read_stimulus(table, defaults, plan);
  }
  plan.functions = plan.kind == AnalysisKind::kPsychometric ||
                   (plan.kind == AnalysisKind::kDetection && table.has("function"));
  if (plan.functions) {
    read_psychometric(table, defaults, plan);
  }
  return plan;
}

}  // namespace haptrial::analysis::trials
