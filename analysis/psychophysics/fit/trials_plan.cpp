#include "analysis/psychophysics/fit/trials_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/base/nearest.h"

namespace haptrial::analysis::trials {
namespace {

using psychometric::Scale;

const std::vector<std::pair<std::string, AnalysisKind>>& kinds() {
  static const std::vector<std::pair<std::string, AnalysisKind>> all{
      {"psychometric", AnalysisKind::kPsychometric},
      {"detection", AnalysisKind::kDetection},
      {"identification", AnalysisKind::kIdentification},
      {"magnitude", AnalysisKind::kMagnitude},
      {"adjustment", AnalysisKind::kAdjustment},
      {"times", AnalysisKind::kTimes},
      {"reaching", AnalysisKind::kReaching},
      {"pursuit", AnalysisKind::kPursuit},
      {"produced", AnalysisKind::kProduced},
      {"paired", AnalysisKind::kPaired},
      {"none", AnalysisKind::kNone}};
  return all;
}

constexpr double kMostGuess = 0.9, kMostLapse = 0.49;

bool has_name(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

/// Factors that are told apart if the definition does not say it: none if they may say where the
/// signal is or make cycles.
std::vector<std::string> usual_by(AnalysisKind kind, const PlanDefaults& defaults) {
  const bool none = kind == AnalysisKind::kDetection || kind == AnalysisKind::kIdentification ||
                    kind == AnalysisKind::kReaching || kind == AnalysisKind::kPaired;
  std::vector<std::string> by = none ? std::vector<std::string>{} : defaults.factors;
  if (kind == AnalysisKind::kAdjustment) {
    std::erase_if(
        by, [&](const std::string& name) { return has_name(defaults.within_settings, name); });
  }
  return by;
}

std::vector<std::string> names_of(const PlanDefaults& defaults) {
  std::vector<std::string> known = defaults.factors;
  known.insert(known.end(), defaults.names.begin(), defaults.names.end());
  return known;
}

void check_by(Table& table, const PlanDefaults& defaults, const TrialsPlan& plan) {
  const std::vector<std::string> known = names_of(defaults);
  for (const std::string& name : plan.by) {
    if (!has_name(known, name)) {
      table.reject("by", fmt::format("an array with \"{}\"", name),
                   fmt::format("{}", fmt::join(known, ", ")));
    } else if (plan.kind == AnalysisKind::kAdjustment && has_name(defaults.within_settings, name)) {
      table.reject("by", fmt::format("has \"{0}\", which varies while a level is adjusted; add by "
                                     "= [\"{0}\"] to the procedure",
                                     name));
    }
  }
}

void check_baseline(Table& table, const PlanDefaults& defaults, const TrialsPlan& plan) {
  if (!has_name(defaults.sessions, plan.baseline)) {
    table.reject("baseline", fmt::format("\"{}\"", plan.baseline),
                 fmt::format("a session: {}", fmt::join(defaults.sessions, ", ")));
  } else if (!has_name(plan.by, kSession)) {
    table.reject("baseline", "stands alone; add \"session\" to `by`");
  }
}

/// The question whose answers count; null: it is not known.
const PlanQuestion* question_of(const PlanDefaults& defaults, const TrialsPlan& plan) {
  const auto named = plan.question.empty() ? defaults.questions.begin()
                                           : std::ranges::find(defaults.questions, plan.question,
                                                               &PlanQuestion::name);
  return named == defaults.questions.end() ? nullptr : &*named;
}

std::size_t alternatives(const PlanDefaults& defaults, const TrialsPlan& plan) {
  const PlanQuestion* question = question_of(defaults, plan);
  return question == nullptr ? 0 : question->alternatives();
}

/// The first other question of which no answer is right.
std::string usual_rating(const PlanDefaults& defaults, const TrialsPlan& plan) {
  const PlanQuestion* question = question_of(defaults, plan);
  const auto other = std::ranges::find_if(defaults.questions, [&](const PlanQuestion& each) {
    return &each != question && !each.judged;
  });
  return other == defaults.questions.end() ? std::string() : other->name;
}

/// 1 / alternatives where it counts whether an answer is right; nothing where an answer "yes", or a
/// formula from which a procedure learns, is what counts.
std::optional<double> usual_guess(const PlanDefaults& defaults, const TrialsPlan& plan) {
  const PlanQuestion* question = question_of(defaults, plan);
  const bool formula = plan.question.empty() && defaults.counts_formula;
  if (question == nullptr || !question->judged || question->alternatives() < 2 || formula ||
      !plan.yes.empty()) {
    return std::nullopt;
  }
  return 1.0 / static_cast<double>(question->alternatives());
}

void set_guess(const std::optional<double>& guess, TrialsPlan& plan) {
  plan.guess_free = !guess.has_value();
  plan.function.guess = guess.value_or(0.0);
}

/// The first factor whose levels are choices of the response, else the first factor.
std::string usual_stimulus(const PlanDefaults& defaults, const std::vector<std::string>& choices) {
  const auto named = std::ranges::find_if(defaults.factors, [&](const std::string& factor) {
    const auto levels = defaults.levels.find(factor);
    return levels != defaults.levels.end() &&
           std::ranges::all_of(levels->second,
                               [&](const std::string& level) { return has_name(choices, level); });
  });
  return named != defaults.factors.end() ? *named
         : defaults.factors.empty()      ? ""
                                         : defaults.factors.front();
}

DiscriminationTask usual_task(const PlanDefaults& defaults, const TrialsPlan& plan) {
  const bool alone = plan.alternatives() == 2 && defaults.cues.intervals.size() < 2;
  return alone ? DiscriminationTask::kOneInterval : DiscriminationTask::kForcedChoice;
}

void check_task(Table& table, const TrialsPlan& plan) {
  if (plan.discrimination == DiscriminationTask::kOneInterval && plan.alternatives() != 2) {
    table.reject("task", "\"one interval\"",
                 "another one if the response does not have two choices");
  }
}

void check_stimulus(Table& table, const PlanDefaults& defaults, TrialsPlan& plan) {
  if (!has_name(defaults.factors, plan.stimulus) && !has_name(defaults.names, plan.stimulus)) {
    table.reject("stimulus", fmt::format("\"{}\"", plan.stimulus),
                 "the factor that says what was presented");
  }
  if (plan.choices.empty()) {
    table.reject("kind", "\"identification\"", "another kind where the response has no choices");
  }
}

/// Lines go over a level that is stated and varies within conditions.
void check_times(Table& table, const PlanDefaults& defaults, TrialsPlan& plan) {
  const std::vector<std::string>& stages = defaults.reaching.stages;
  if (!plan.stage.empty() && !has_name(stages, plan.stage)) {
    table.reject("stage", fmt::format("\"{}\"", plan.stage),
                 fmt::format("a stage: {}", fmt::join(stages, ", ")));
  }
  if (plan.level_assumed || !table.has("level")) {
    plan.level.clear();
  }
}

void check_diffusion(Table& table, const PlanDefaults& defaults, const TrialsPlan& plan) {
  if (plan.diffusion && plan.yes.empty() && alternatives(defaults, plan) != 2) {
    table.reject("diffusion", "true", "false where the response does not have two choices");
  }
}

/// The keys of a diffusion model of the choices.
const Schema<DiffusionOptions>& diffusion_schema() {
  using D = DiffusionOptions;
  static const auto schema =
      Schema<D>()
          .number("start_point", &D::start, {0.05, 0.95}, "1",
                  "Where the diffusion begins, as a share of the way from the boundary of wrong "
                  "answers to that of right ones")
          .number("contaminants", &D::contaminants, {0.0, 0.2}, "1",
                  "Share of answers that are guesses at any time, which the diffusion model allows "
                  "for");
  return schema;
}

/// PAGE.SCORE, of a page of the definition.
void read_covariate(Table& table, const std::string& key, const PlanDefaults& defaults,
                    TrialsPlan& plan) {
  const std::string name = table.text(key);
  const std::string page = name.substr(0, name.find('.'));
  if (page == name || !has_name(defaults.pages, page)) {
    table.reject(
        key, fmt::format("\"{}\"", name),
        fmt::format("PAGE.SCORE with a page of questions: {}",
                    defaults.pages.empty() ? "there is none"
                                           : fmt::format("{}", fmt::join(defaults.pages, ", "))));
  }
  plan.plan.covariate.name = name;
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

/// The levels that the functions are of; else those of the first procedure. Null: there is none.
const ProcedureLevels* levels_of(const PlanDefaults& defaults, const TrialsPlan& plan) {
  const auto own = std::ranges::find(defaults.procedures, plan.level, &ProcedureLevels::variable);
  return own != defaults.procedures.end() ? &*own
         : defaults.procedures.empty()    ? nullptr
                                          : &defaults.procedures.front();
}

psychometric::Axis axis_of(const PlanDefaults& defaults, const TrialsPlan& plan) {
  const ProcedureLevels* levels = levels_of(defaults, plan);
  return levels != nullptr ? levels->axis : psychometric::Axis{};
}

/// Functions have one axis: with procedures of several variables that of the first, unless stated.
void settle_level(const PlanDefaults& defaults, TrialsPlan& plan) {
  plan.level_assumed = plan.level.empty() && defaults.procedures.size() > 1;
  if (plan.level_assumed) {
    plan.level = defaults.procedures.front().variable;
  }
  plan.level_is_set = std::ranges::find(defaults.procedures, plan.level,
                                        &ProcedureLevels::variable) != defaults.procedures.end();
}

void check_function(Table& table, const PlanDefaults& defaults, TrialsPlan& plan) {
  try {
    psychometric::set_sigmoid(plan.function, plan.function_name, Scale::kNaturalLog);
  } catch (const std::invalid_argument& error) {
    table.reject("function", fmt::format("cannot be read: {}", error.what()));
  }
  const ProcedureLevels* levels = levels_of(defaults, plan);
  if (levels != nullptr && levels->falls && plan.yes.empty() && plan.question.empty()) {
    match_direction(table, *levels->falls, plan);
  }
}

const Schema<psychometric::Axis>& axis_schema() {
  using A = psychometric::Axis;
  static const auto schema =
      Schema<A>()
          .choice("scale", &A::scale,
                  {{"linear", Scale::kLinear},
                   {"log10", Scale::kLog10},
                   {"ln", Scale::kNaturalLog},
                   {"decibel", Scale::kDecibel}},
                  "Scale of the axis of levels on which functions are fitted")
          .otherwise("of the procedure")
          .custom("origin", "Level from which the scale of the axis measures",
                  [](Table& table, const std::string& key, A& axis) {
                    axis.origin = table.number(key, {}, axis.unit);
                  })
          .otherwise("of the procedure");
  return schema;
}

void read_guess(Table& table, const std::string& key, TrialsPlan& plan) {
  if (table.has_text(key)) {
    const std::string word = table.choice(key, {"free", "lapse"});
    plan.guess_is_lapse = word == "lapse";
    plan.guess_free = word == "free";
    plan.function.guess = 0.0;
  } else {
    plan.function.guess = table.number(key, {0.0, kMostGuess}, "");
    plan.guess_free = false;
  }
}

void read_lapse(Table& table, const std::string& key, TrialsPlan& plan) {
  if (!table.is_table(key)) {
    plan.lapse.low = plan.lapse.high = table.number(key, {0.0, kMostLapse}, "");
    return;
  }
  Table lapse = table.table(key);
  lapse.describe({"free", "Whether the lapse rate is fitted", "true", false});
  const bool free = !lapse.has("free") || lapse.boolean("free");
  lapse.describe({"at_most", "Highest lapse rate that a fit may give",
                  "0.2; 0.06 if guess is \"lapse\"", false});
  plan.lapse.high =
      lapse.has("at_most") ? lapse.number("at_most", {0.0, kMostLapse}, "") : plan.lapse.high;
  plan.lapse.low = free ? 0.0 : plan.lapse.high;
}

double guess_of(const TrialsPlan& plan) { return plan.guess_free ? 0.0 : plan.function.guess; }

void read_threshold(Table& table, const std::string& key, TrialsPlan& plan) {
  const double guess = guess_of(plan);
  const double usual = plan.threshold_at;
  plan.threshold_at = table.number(key, {0.0, 1.0}, "");
  if (!(plan.threshold_at > guess && plan.threshold_at < 1.0)) {
    table.reject(key, fmt::format("{}", plan.threshold_at),
                 fmt::format("a number above {} and below 1", guess));
    plan.threshold_at = usual;
  }
}

/// The keys of functions of the level.
Schema<TrialsPlan> make_function_schema(const PlanDefaults& defaults) {
  using P = TrialsPlan;
  return Schema<P>()
      .text("function", &P::function_name,
            "Sigmoid that is fitted; with neg_ before its name it falls")
      .otherwise("norm; neg_norm with right_raises")
      .check([&](Table& table, P& plan) {
        plan.function.axis = axis_of(defaults, plan);
        check_function(table, defaults, plan);
        axis_schema().read(table, plan.function.axis);
        set_guess(usual_guess(defaults, plan), plan);
      })
      .custom("guess",
              "Guess rate of the functions, \"free\" (at most 0.2; with catch trials 0.5), or "
              "\"lapse\", which is as large as the lapse rate",
              read_guess)
      .otherwise("1 / choices, else free")
      .derive([](P& plan) {
        if (plan.guess_is_lapse) {
          plan.lapse = {};  // it counts on both sides
        }
      })
      .custom("lapse", "Lapse rate of the functions, or how it is fitted", read_lapse)
      .otherwise("{ free = true, at_most = 0.2 }")
      .derive([](P& plan) { plan.threshold_at = 0.5 * (1.0 + guess_of(plan)); })
      .custom("threshold_at", "Share of answers 1 at the threshold, lapses aside", read_threshold)
      .otherwise("halfway from the guess rate to 1; 0.5 if that is free")
      .derive([](P& plan) {
        plan.function.share = (plan.threshold_at - guess_of(plan)) / (1.0 - guess_of(plan));
      })
      .custom("reference", "Level of the standard stimulus, to which Weber fractions relate",
              [](Table& table, const std::string& key, P& plan) {
                plan.reference = table.number(key, kPositive, plan.function.axis.unit);
              })
      .otherwise("no Weber fractions")
      .flag("bayesian", &P::bayesian, "Whether a Bayesian fit of each function is added")
      .flag("hierarchical", &P::hierarchical,
            "Whether one Bayesian model of all participants and conditions is added: thresholds, "
            "widths and lapse rates of the group and of each participant, from three participants "
            "on")
      .integer("resamples", &P::resamples, 0, 100'000, "Resamples of the bootstrap")
      .check([&](Table& table, P& plan) {
        plan.cues = read_cue_plan(table, defaults.cues, plan.by, guess_of(plan));
      });
}

bool reaches(const TrialsPlan& plan) { return plan.kind == AnalysisKind::kReaching; }
bool answers(const TrialsPlan& plan) {
  return !reaches(plan) && plan.kind != AnalysisKind::kPursuit &&
         plan.kind != AnalysisKind::kProduced;
}
bool is_timed(const TrialsPlan& plan) { return plan.kind == AnalysisKind::kTimes; }
bool has_magnitudes(const TrialsPlan& plan) { return plan.kind == AnalysisKind::kMagnitude; }
bool identifies(const TrialsPlan& plan) { return plan.kind == AnalysisKind::kIdentification; }
bool may_rate(const TrialsPlan& plan) {
  return plan.kind == AnalysisKind::kDetection || identifies(plan);
}

void check_measured(Table& table, const PlanDefaults& defaults, const TrialsPlan& plan) {
  std::vector<std::string> names;
  std::ranges::transform(defaults.produced.measures, std::back_inserter(names), &MeasureName::name);
  if (!plan.measured.empty() && !has_name(names, plan.measured)) {
    table.reject("measured", fmt::format("\"{}\"", plan.measured),
                 names.empty() ? "a name of [measures], of which there is none"
                               : fmt::format("one of: {}", fmt::join(names, ", ")));
  }
}

/// @throws as Table::reject(), if a key names what the definition does not have
void check_known(Table& table, const char* key, const std::string& name, const char* what,
                 const std::vector<std::string>& known) {
  if (!name.empty() && !known.empty() && !has_name(known, name)) {
    table.reject(key, fmt::format("\"{}\"", name),
                 fmt::format("{}: {}", what, fmt::join(known, ", ")));
  }
}

std::vector<std::string> question_names(const PlanDefaults& defaults) {
  std::vector<std::string> names;
  std::ranges::transform(defaults.questions, std::back_inserter(names), &PlanQuestion::name);
  return names;
}

/// An answer that no choice is called would never be given.
void check_answers(Table& table, const PlanDefaults& defaults, TrialsPlan& plan) {
  check_known(table, "question", plan.question, "a question", question_names(defaults));
  check_known(table, "level", plan.level, "a variable of the trials", defaults.produced.variables);
  const PlanQuestion* question = question_of(defaults, plan);
  if (question == nullptr || question->choices.empty()) {
    return;
  }
  check_known(table, "yes", plan.yes, "an answer", question->choices);
  if (plan.kind == AnalysisKind::kDetection && plan.yes.empty() &&
      !has_name(question->choices, "yes")) {
    table.reject("yes", fmt::format("is missing, and no answer is \"yes\"; add the one that says "
                                    "that there was a signal: {}",
                                    fmt::join(question->choices, ", ")));
  }
}

/// One level has no function and no slope: the factor that is the level makes no conditions.
void check_level_by(Table& table, TrialsPlan& plan) {
  if (plan.level.empty() || !has_name(plan.by, plan.level)) {
    return;
  }
  if (!table.has("by")) {
    std::erase(plan.by, plan.level);
  } else if (plan.kind != AnalysisKind::kDetection || table.has("function")) {
    table.reject("level", fmt::format("\"{}\", which `by` names, too", plan.level),
                 "a variable that varies within each condition");
  }
}

/// The keys that say which answers are compared.
void add_answers(Schema<TrialsPlan>& schema, const PlanDefaults& defaults) {
  using P = TrialsPlan;
  schema.text("question", &P::question, "Name of the question whose answers count")
      .otherwise("the first")
      .only_if(answers)
      .text("yes", &P::yes, "Answer that counts 1; every other counts 0")
      .otherwise("what the procedure learnt, else the right one")
      .only_if(answers)
      .text("level", &P::level, "Variable that is the level of a trial")
      .otherwise("the one that the procedure set; of several, the first procedure's")
      .only_if(answers)
      .check([&](Table& table, P& plan) {
        if (answers(plan) && plan.kind != AnalysisKind::kNone) {
          check_answers(table, defaults, plan);
          check_level_by(table, plan);
        }
      })
      .derive([&](P& plan) {
        settle_level(defaults, plan);
        plan.rating = may_rate(plan) ? usual_rating(defaults, plan) : "";
        if (identifies(plan)) {
          if (const PlanQuestion* question = question_of(defaults, plan)) {
            plan.choices = question->choices;
            plan.last_is_silent = question->last_is_silent;
          }
          plan.stimulus = usual_stimulus(defaults, plan.choices);
          plan.discrimination = usual_task(defaults, plan);
        }
      })
      .text("rating", &P::rating, "Question of how sure the participant was")
      .otherwise("the second question")
      .only_if(may_rate)
      .check([&](Table& table, P& plan) {
        check_known(table, "rating", plan.rating, "a question", question_names(defaults));
      })
      .text("stimulus", &P::stimulus, "Factor that says which stimulus was presented")
      .otherwise("the first factor whose levels are choices, else the first factor")
      .only_if(identifies)
      .check([&](Table& table, P& plan) {
        if (identifies(plan)) {
          check_stimulus(table, defaults, plan);
        }
      })
      .choice("task", &P::discrimination,
              {{"forced choice", DiscriminationTask::kForcedChoice},
               {"one interval", DiscriminationTask::kOneInterval},
               {"oddity", DiscriminationTask::kOddity},
               {"ABX", DiscriminationTask::kAbx},
               {"same-different", DiscriminationTask::kSameDifferent}},
              "Task whose d' is computed from the share of right answers: which of the stimuli it "
              "was, which of two was presented alone, which of three differs, whether the third is "
              "as the first or the second, whether two are the same")
      .otherwise("forced choice; of two choices in trials of one interval: one interval")
      .only_if(identifies)
      .check([](Table& table, P& plan) {
        if (identifies(plan)) {
          plan.task_assumed = !table.has("task");
          check_task(table, plan);
        }
      })
      .flag("metacognition", &P::metacognition,
            "Whether ratings of confidence give meta-d' and its ratio to d' (M-ratio), of two "
            "stimuli")
      .only_if(may_rate)
      .check([&](Table& table, P& plan) {
        if (plan.metacognition && plan.rating.empty()) {
          table.reject("metacognition", "true", "false where no question asks for confidence");
        } else if (plan.metacognition && identifies(plan) && plan.alternatives() != 2) {
          table.reject("metacognition", "true",
                       "false where the response does not have two choices");
        }
      })
      .text("measured", &P::measured,
            "Measure of what the stimulus was in each trial; the exponent then allows for errors "
            "of both the stimulus and the number that was given")
      .otherwise("stimuli are exactly at their levels")
      .only_if(has_magnitudes)
      .check([&](Table& table, P& plan) {
        if (has_magnitudes(plan)) {
          check_measured(table, defaults, plan);
        }
      })
      .text("stage", &P::stage, "Stage whose duration is the time")
      .otherwise("times are reaction times of the answers")
      .only_if(is_timed)
      .check([&](Table& table, P& plan) {
        if (is_timed(plan)) {
          check_times(table, defaults, plan);
        }
      })
      .flag("diffusion", &P::diffusion,
            "Whether a diffusion model of two choices is fitted to each participant's answers and "
            "times: drift, boundary and non-decision time")
      .only_if(is_timed)
      .check([&](Table& table, P& plan) {
        if (is_timed(plan)) {
          check_diffusion(table, defaults, plan);
          diffusion_schema().read(table, plan.diffusion_options);
        }
      });
}

Schema<TrialsPlan> make_plan_schema(const PlanDefaults& defaults) {
  using P = TrialsPlan;
  Schema<P> schema;
  schema.choice("kind", &P::kind, kinds(), "Kind of the analysis")
      .otherwise("as the procedure is")
      .check([&](Table& table, P& plan) {
        if (reaches(plan)) {
          plan.reaching = read_reaching_plan(table, defaults.reaching);
        }
        if (plan.kind == AnalysisKind::kPursuit) {
          plan.pursuit = read_pursuit_plan(table, defaults.pursuit);
        }
        if (plan.kind == AnalysisKind::kProduced) {
          plan.produced = read_produced_plan(table, defaults.produced);
        }
        if (plan.kind == AnalysisKind::kPaired) {
          plan.paired = read_paired_plan(table, names_of(defaults));
        }
        plan.by = usual_by(plan.kind, defaults);
        if (is_timed(plan) && table.has("level")) {
          plan.by.clear();  // factors may make the level, or vary for other reasons
        }
      })
      .custom("by",
              "Factors whose levels are told apart: each combination has a function, d' or "
              "exponent of its own",
              [&](Table& table, const std::string& key, P& plan) {
                plan.by = table.texts(key);
                check_by(table, defaults, plan);
              })
      .otherwise(
          "all factors but the level as written; of detection, identification, reaching, paired "
          "and times over a "
          "level none")
      .derive([](P& plan) {
        if (plan.kind == AnalysisKind::kPaired) {
          plan.by.emplace_back(kItem);
        }
      })
      .custom("baseline",
              "Session from which changes are compared in place of values, by its name; `by` has "
              "\"session\" then, and tests compare changes",
              [&](Table& table, const std::string& key, P& plan) {
                plan.baseline = table.text(key);
                check_baseline(table, defaults, plan);
              })
      .otherwise("none")
      .custom(
          "tests",
          "Tests that were planned before the data: \"a < b\", \"a > b\" or \"a != b\" of levels "
          "of the factors in `by`",
          [&](Table& table, const std::string&, P& plan) { read_tests(table, defaults, plan); })
      .otherwise("none")
      .text("tests_of", &P::tests_of,
            "The quantity that the planned tests are of, by its name in results.json; the same "
            "tests of others are secondary, and adjusted together")
      .otherwise("that of analysis.sequential, else the first that is compared")
      .keys_of(&P::plan, tests_beside_schema())
      .custom(
          "covariate",
          "Score of a page of questions, as PAGE.SCORE, that is held in tests between people; of "
          "conditions that the same people had, whether their differences follow it",
          [&](Table& table, const std::string& key, P& plan) {
            read_covariate(table, key, defaults, plan);
          })
      .otherwise("none");
  add_answers(schema, defaults);
  schema.check([&](Table& table, P& plan) {
    if (plan.plan.sequential && plan.plan.sequential->of.empty()) {
      plan.plan.sequential->of = plan.tests_of;
    }
    plan.functions = plan.kind == AnalysisKind::kPsychometric ||
                     (plan.kind == AnalysisKind::kDetection && table.has("function"));
    if (plan.functions) {
      make_function_schema(defaults).read(table, plan);
    }
  });
  return schema;
}

}  // namespace

const char* name_of(AnalysisKind kind) {
  const auto found = std::ranges::find(kinds(), kind, [](const auto& each) { return each.second; });
  return found->first.c_str();
}

PlannedTest with_short_numbers(PlannedTest test) {
  test.a = short_number(test.a);
  test.b = short_number(test.b);
  return test;
}

TrialsPlan read_trials_plan(Table& root, const PlanDefaults& defaults) {
  TrialsPlan plan;
  plan.kind = defaults.kind;
  plan.sessions = defaults.sessions;
  plan.by = usual_by(plan.kind, defaults);
  plan.functions = plan.kind == AnalysisKind::kPsychometric;
  set_guess(usual_guess(defaults, plan), plan);
  settle_level(defaults, plan);
  plan.function.axis = axis_of(defaults, plan);
  if (!root.has("analysis")) {
    plan.threshold_at = 0.5 * (1.0 + plan.function.guess);
    return plan;
  }
  plan.level = {};
  Table table = root.table("analysis");
  make_plan_schema(defaults).read(table, plan);
  return plan;
}

}  // namespace haptrial::analysis::trials
