#include "core/psychometric/definition/read_quest.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "core/base/definition/expression.h"
#include "core/base/definition/labels.h"
#include "core/base/error.h"
#include "core/base/exception_words.h"
#include "core/psychometric/definition/grid.h"
#include "core/psychometric/definition/track.h"
#include "core/psychometric/function/sigmoid_names.h"
#include "core/psychometric/procedure/psi_definition.h"

namespace haptrial::psychometric {
namespace {

/// Pairs of stimulus and parameters: the tables take 36 bytes for each with two outcomes.
constexpr double kMostPairs = 1e7;
constexpr std::size_t kMostOutcomes = 64;

/// Reads the levels that stand beside a grid, which has a table of its own then.
std::vector<double> read_levels(Table& all, const std::string& name) {
  if (!all.is_table(name)) {
    return read_grid(all, name);
  }
  Table own = all.table(name);
  return own.has("values") ? own.numbers("values", {}, "") : read_spaced_grid(own);
}

void read_stimulus(const TrackKeys& keys, QuestDefinition& quest, Track& track) {
  Table all = keys.of("stimulus").table("stimulus");
  for (const std::string& name : all.keys_as_written()) {
    std::vector<double> values = read_levels(all, name);
    double resolution = 0.0;
    if (all.is_table(name)) {
      Table own = all.table(name);
      resolution = own.number_or("resolution", 0.0, kPositive, "");
    }
    if (values.empty()) {
      continue;
    }
    const auto [low, high] = std::ranges::minmax(values);
    if (quest.stimulus.empty()) {
      track.variable = name;
      track.low = low;
      track.high = high;
      track.resolution = resolution;
    } else {
      track.further.push_back({name, low, high, resolution});
    }
    quest.stimulus.push_back({name, std::move(values), {}, false});
  }
  if (quest.stimulus.empty()) {
    keys.of("stimulus").reject("stimulus", "names no variable; add NAME = [levels]");
  }
}

std::vector<double> read_prior(Table& own, const std::vector<double>& values) {
  if (!own.is_table("prior")) {
    std::vector<double> weights = own.numbers("prior", kNonNegative, "");
    if (weights.size() != values.size()) {
      own.reject("prior", fmt::format("a list of {}", weights.size()),
                 fmt::format("{}, a weight for each value", values.size()));
      return {};
    }
    return weights;
  }
  Table normal = own.table("prior");
  const double mean = normal.number("mean", {}, "");
  const double sd = normal.number("sd", kPositive, "");
  std::vector<double> weights;
  for (const double value : values) {
    const double z = (value - mean) / sd;
    weights.push_back(std::exp(-0.5 * z * z));
  }
  return weights;
}

void read_parameters(const TrackKeys& keys, QuestDefinition& quest) {
  Table all = keys.of("parameters").table("parameters");
  for (const std::string& name : all.keys_as_written()) {
    QuestDimension parameter{name, read_levels(all, name), {}, false};
    if (all.is_table(name)) {
      Table own = all.table(name);
      if (own.has("prior")) {
        parameter.prior = read_prior(own, parameter.values);
      }
      parameter.nuisance = own.has("nuisance") && own.boolean("nuisance");
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

std::vector<std::string> read_probability(const TrackKeys& keys) {
  if (!keys.has("probability")) {
    return {};
  }
  Table& table = keys.of("probability");
  return table.is_array("probability") ? table.texts("probability")
                                       : std::vector{table.text("probability")};
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
  p.function.axis = track.axis = read_axis(keys, track);
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
  track.begin = [tables, stop](std::uint64_t, const std::string&) {
    return std::make_unique<QuestPlus>(tables, stop);
  };
}

void read_quest(const TrackKeys& keys, const QuestStop& stop, Track& track) {
  QuestDefinition quest;
  read_stimulus(keys, quest, track);
  read_parameters(keys, quest);
  const std::vector<std::string> formulas = read_probability(keys);
  const bool named = keys.has("function");
  const std::string name = named ? keys.of("function").text("function") : "";
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
      take_formulas(keys, formulas, quest);
    }
    check_size(quest);
    if (named) {
      quest = take_function(keys, name, quest, track);
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
