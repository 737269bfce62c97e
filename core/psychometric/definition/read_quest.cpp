#include "core/psychometric/definition/read_procedures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "core/base/definition/expression.h"
#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/base/exception_words.h"
#include "core/psychometric/definition/grid.h"
#include "core/psychometric/definition/track.h"
#include "core/psychometric/definition/track_keys.h"
#include "core/psychometric/function/sigmoid.h"
#include "core/psychometric/procedure/psi_definition.h"

namespace haptrial::psychometric {
namespace {

/// Pairs of stimulus and parameters: the tables take 36 bytes for each with two outcomes.
constexpr double kMostPairs = 1e7;
constexpr std::size_t kMostOutcomes = 64;

constexpr const char* kForms = ": a list, { from, to, count, spacing } or { values }";

const Schema<QuestDimension>& dimension_schema() {
  static const auto schema =
      Schema<QuestDimension>()
          .custom("values", "Values of a level or parameter, one by one",
                  [](Table& table, const std::string& key, QuestDimension& dimension) {
                    dimension.values = table.numbers(key, {}, "");
                  })
          .otherwise("from, to and count")
          .check([](Table& table, QuestDimension& dimension) {
            if (!table.has("values")) {
              dimension.values = read_spaced_grid(table);
            }
          });
  return schema;
}

/// Reads a list of values, or the values of a table that may have further keys.
QuestDimension read_dimension(Table& all, const std::string& name) {
  QuestDimension dimension{name, {}, {}, false};
  if (all.is_table(name)) {
    Table own = all.table(name);
    dimension_schema().read(own, dimension);
  } else {
    dimension.values = read_grid(all, name);
  }
  return dimension;
}

const Schema<TrackDimension>& resolution_schema() {
  using D = TrackDimension;
  static const auto schema = Schema<D>()
                                 .number("resolution", &D::resolution, kPositive, "",
                                         "Number to whose multiples the variable is rounded")
                                 .otherwise("not rounded");
  return schema;
}

struct NormalPrior {
  double mean{0.0};
  double sd{1.0};
};

const Schema<NormalPrior>& normal_prior_schema() {
  using N = NormalPrior;
  static const auto schema =
      Schema<N>()
          .number("mean", &N::mean, {}, "",
                  "Mean of the normal distribution of a parameter before the first trial")
          .required()
          .number(
              "sd", &N::sd, kPositive, "",
              "Standard deviation of the normal distribution of a parameter before the first trial")
          .required();
  return schema;
}

void read_prior(Table& own, const std::string& key, QuestDimension& parameter) {
  const std::size_t count = parameter.values.size();
  if (!own.is_table(key)) {
    parameter.prior = own.numbers(key, kNonNegative, "");
    if (parameter.prior.size() != count) {
      own.reject(key, fmt::format("a list of {}", parameter.prior.size()),
                 fmt::format("{}, a weight for each value", count));
      parameter.prior.clear();
    }
    return;
  }
  Table table = own.table(key);
  const NormalPrior normal = normal_prior_schema().read(table);
  for (const double value : parameter.values) {
    const double z = (value - normal.mean) / normal.sd;
    parameter.prior.push_back(std::exp(-0.5 * z * z));
  }
}

const Schema<QuestDimension>& parameter_schema() {
  static const auto schema =
      Schema<QuestDimension>()
          .custom("prior",
                  "Weights of a parameter's values before the first trial, or { mean, sd } of a "
                  "normal distribution",
                  read_prior)
          .otherwise("all equal")
          .flag("nuisance", &QuestDimension::nuisance,
                "Whether a parameter is a nuisance, on which no trials are spent");
  return schema;
}

void read_parameters(const TrackKeys& keys, QuestDefinition& quest) {
  Table all = keys.of("parameters").table("parameters");
  for (const std::string& name : all.keys_as_written()) {
    all.describe(
        {name, std::string("Values that the parameter of this name may have") + kForms, "", true});
    QuestDimension parameter = read_dimension(all, name);
    if (all.is_table(name)) {
      Table own = all.table(name);
      parameter_schema().read(own, parameter);
    }
    const auto same = [&](const QuestDimension& each) { return each.name == name; };
    if (std::ranges::any_of(quest.stimulus, same)) {
      all.reject(name, "is a variable of the stimulus, too; give one of the two another name");
    }
    quest.parameters.push_back(std::move(parameter));
  }
  if (quest.parameters.empty()) {
    keys.of("parameters").reject("parameters", "names nothing to find out; add NAME = [values]");
  }
}

/// Formulas of probabilities. Evaluating one writes into it, and sessions share a track's tables.
class Formulas {
 public:
  /// @throws InputError saying what is wrong with a formula
  Formulas(const std::vector<std::string>& texts, const QuestDefinition& quest) {
    Labels labels;
    for (const std::string& text : texts) {
      Expression formula(text, labels);
      std::vector<Source> sources;
      for (const std::string& name : formula.names()) {
        sources.push_back(source_of(name, text, quest));
      }
      values_.resize(std::max(values_.size(), sources.size()));
      parts_.push_back({std::move(formula), std::move(sources)});
    }
  }

  void operator()(const double* stimulus, const double* parameters, double* probabilities) {
    const std::lock_guard hold(one_at_a_time_);
    double rest = 1.0;
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      const Part& part = parts_[k];
      for (std::size_t i = 0; i < part.sources.size(); ++i) {
        const Source& source = part.sources[i];
        values_[i] = (source.of_stimulus ? stimulus : parameters)[source.index];
      }
      probabilities[k + 1] = part.formula.value_at({values_.data(), part.sources.size()});
      rest -= probabilities[k + 1];
    }
    constexpr double kRounding = 1e-12;
    probabilities[0] = std::abs(rest) < kRounding ? 0.0 : rest;
  }

 private:
  struct Source {
    bool of_stimulus;
    std::size_t index;
  };
  struct Part {
    Expression formula;
    std::vector<Source> sources;  // of its names
  };

  static Source source_of(const std::string& name, const std::string& text,
                          const QuestDefinition& quest) {
    std::vector<std::string> known;
    for (const bool of_stimulus : {true, false}) {
      const auto& all = of_stimulus ? quest.stimulus : quest.parameters;
      for (std::size_t i = 0; i < all.size(); ++i) {
        if (all[i].name == name) {
          return {of_stimulus, i};
        }
        known.push_back(all[i].name);
      }
    }
    throw InputError(
        fmt::format("\"{}\" names {}; allowed: {}", text, name, fmt::join(known, ", ")));
  }

  std::mutex one_at_a_time_;
  std::vector<Part> parts_;
  std::vector<double> values_;
};

/// Ways from a stimulus to the probabilities of answers, of which one is stated.
struct AnswerModel {
  std::vector<std::string> formulas;
  std::string function;
};

const Schema<AnswerModel>& answer_model_schema() {
  using M = AnswerModel;
  static const auto schema =
      Schema<M>()
          .custom("probability",
                  "Formula of the probability of the answer 1, or a list of formulas, for the "
                  "answers 1, 2 and so on",
                  [](Table& table, const std::string& key, M& model) {
                    model.formulas =
                        table.is_array(key) ? table.texts(key) : std::vector{table.text(key)};
                  })
          .otherwise("needed; or a function")
          .text("function", &M::function, kFunctionText)
          .otherwise(kFunctionAbsent);
  return schema;
}

void take_formulas(const TrackKeys& keys, const std::vector<std::string>& texts,
                   QuestDefinition& quest) {
  Table& table = keys.of("probability");
  quest.outcomes = texts.size() + 1;
  if (texts.empty() || quest.outcomes > kMostOutcomes) {
    table.reject("probability", fmt::format("a list of {}", texts.size()),
                 fmt::format("1 to {} formulas", kMostOutcomes - 1));
    return;
  }
  const auto formulas = std::make_shared<Formulas>(texts, quest);
  quest.model = [formulas](const double* stimulus, const double* parameters, double* p) {
    (*formulas)(stimulus, parameters, p);
  };
  if (quest.outcomes > 2 && !keys.has("counts")) {
    table.reject("probability",
                 fmt::format("is of {} answers; add counts, a formula that is 0 to {}",
                             quest.outcomes, quest.outcomes - 1));
  }
}

/// A sigmoid of one stimulus: psi's model, with priors.
QuestDefinition take_function(const TrackKeys& keys, const std::string& name,
                              const QuestDefinition& quest, Track& track) {
  PsiParameters p;
  p.levels = quest.stimulus.front().values;
  p.function.axis = read_axis(keys, track);
  p.function.guess = 0.5;
  set_sigmoid(p.function, name, Scale::kLog10);
  track.falls = p.function.falling;
  if (quest.stimulus.size() > 1) {
    throw InputError(
        fmt::format("is of one stimulus, and there are {}; state a probability, a "
                    "formula",
                    quest.stimulus.size()));
  }
  for (const QuestDimension& each : quest.parameters) {
    QuestDimension* place = each.name == "threshold" ? &p.threshold
                            : each.name == "width"   ? &p.width
                            : each.name == "guess"   ? &p.guess
                            : each.name == "lapse"   ? &p.lapse
                                                     : nullptr;
    if (place == nullptr) {
      throw InputError(
          fmt::format("has no parameter {}; it has threshold, width, guess and lapse", each.name));
    }
    *place = each;
  }
  if (p.threshold.values.empty() || p.width.values.empty()) {
    throw InputError("needs the parameters threshold and width");
  }
  QuestDefinition psi = psi_definition(p);
  psi.stimulus.front().name = quest.stimulus.front().name;
  return psi;
}

void check_size(const QuestDefinition& quest) {
  double pairs = 1.0;
  for (const auto* all : {&quest.stimulus, &quest.parameters}) {
    for (const QuestDimension& each : *all) {
      pairs *= static_cast<double>(std::max<std::size_t>(1, each.values.size()));
    }
  }
  if (pairs > kMostPairs) {
    throw InputError(
        fmt::format("stimulus and parameters have {:.3g} pairs of values together; allowed: "
                    "at most {:.0e}",
                    pairs, kMostPairs));
  }
}

}  // namespace

std::vector<QuestDimension> read_stimulus(const TrackKeys& keys, Track& track) {
  std::vector<QuestDimension> stimulus;
  Table all = keys.of("stimulus").table("stimulus");
  for (const std::string& name : all.keys_as_written()) {
    all.describe({name, std::string("Levels of the variable of this name") + kForms, "", true});
    QuestDimension levels = read_dimension(all, name);
    TrackDimension own{name};
    if (all.is_table(name)) {
      Table table = all.table(name);
      resolution_schema().read(table, own);
    }
    if (levels.values.empty()) {
      continue;
    }
    const auto [low, high] = std::ranges::minmax(levels.values);
    own.low = low;
    own.high = high;
    if (!has_multiple(low, high, own.resolution)) {
      all.table(name).reject(
          "resolution", fmt::format("{:g}", own.resolution),
          fmt::format("one with a multiple in the range, {:g} to {:g}", low, high));
    }
    if (stimulus.empty()) {
      track.variable = name;
      track.low = own.low;
      track.high = own.high;
      track.resolution = own.resolution;
    } else {
      track.further.push_back(own);
    }
    stimulus.push_back(std::move(levels));
  }
  if (stimulus.empty()) {
    keys.of("stimulus").reject("stimulus", "names no variable; add NAME = [levels]");
  }
  return stimulus;
}

QuestStop read_quest_stop(const TrackKeys& keys, Track& track) {
  const TrackStop stop = read_stop(keys, track);
  return {stop.trials, stop.entropy};
}

void begin_with(const TrackKeys& keys, const std::shared_ptr<const QuestTables>& tables,
                const QuestStop& stop, Track& track) {
  const QuestPlus begun(tables, stop);
  if (begun.finished()) {
    Table ends = keys.of("stop").table("stop");
    ends.reject("entropy", fmt::format("{:g} [nat]", stop.entropy),
                fmt::format("less than the {:.3g} nat before the first trial, or the track ends "
                            "there",
                            begun.entropy()));
  }
  std::vector<std::string> parameters;
  for (const QuestDimension& each : tables->definition().parameters) {
    parameters.push_back(each.values.size() == 1
                             ? fmt::format("{} {:g}", each.name, each.values.front())
                             : fmt::format("{} ({} values from {:g} to {:g}{})", each.name,
                                           each.values.size(), std::ranges::min(each.values),
                                           std::ranges::max(each.values),
                                           each.nuisance ? ", a nuisance" : ""));
  }
  track.rule = fmt::format(
      "Each trial had the level that was expected to tell most, by the entropy of the posterior of "
      "{}{}. {} The estimate is the mean of the posterior.",
      fmt::join(parameters, ", "),
      track.axis.x_unit().empty() || track.kind != "psi" ? ""
                                                         : " on the axis " + track.axis.x_unit(),
      words_of(TrackStop{0, stop.trials, stop.entropy}));
  track.begin = [tables, stop](std::uint64_t, const std::string&) {
    return std::make_unique<QuestPlus>(tables, stop);
  };
  track.warnings = [tables](const Track& named) { return quest_warnings(named, *tables); };
}

void read_quest(const TrackKeys& keys, Track& track) {
  const QuestStop stop = read_quest_stop(keys, track);
  QuestDefinition quest;
  quest.stimulus = read_stimulus(keys, track);
  read_parameters(keys, quest);
  AnswerModel model;
  answer_model_schema().read(keys.track, keys.procedure, model);
  const bool named = keys.has("function");
  const char* key = named ? "function" : "probability";
  if (named == keys.has("probability")) {
    keys.of("kind").reject("kind",
                           "is \"quest_plus\", which needs one way from stimulus to answer; state "
                           "probability, a formula, or function, a sigmoid");
    return;
  }
  if (quest.stimulus.empty() || quest.parameters.empty()) {
    return;
  }
  try {
    if (!named) {
      take_formulas(keys, model.formulas, quest);
    }
    check_size(quest);
    if (named) {
      quest = take_function(keys, model.function, quest, track);
    }
    if (!quest.model) {
      return;
    }
    const auto tables = std::make_shared<const QuestTables>(std::move(quest));
    track.outcomes = tables->outcomes();
    begin_with(keys, tables, stop, track);
  } catch (const std::exception& error) {
    keys.of(key).reject(key, fmt::format("cannot be used as stated: {}", sentence_of(error)));
  }
}

}  // namespace haptrial::psychometric
