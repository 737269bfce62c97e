#include "core/psychometric/procedure/quest_tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "core/psychometric/procedure/information.h"
#include "core/psychometric/procedure/surprise.h"

namespace haptrial::psychometric {
namespace {

using Dimensions = std::vector<QuestDimension>;

// Products of a weight and a probability that are not less than these are normal numbers.
constexpr double kLeastProbability = 1e-17;

void require_table(bool holds, const std::string& sentence) {
  if (!holds) {
    throw std::invalid_argument("QuestTables: " + sentence);
  }
}

bool all_finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

void check_dimension(const QuestDimension& d) {
  require_table(!d.values.empty(), "values of " + d.name + " must not be empty");
  require_table(all_finite(d.values), "values of " + d.name + " must be finite");
  if (!d.prior.empty()) {
    require_table(d.prior.size() == d.values.size(),
                  "prior of " + d.name + " must have a weight a value");
    require_table(all_finite(d.prior) && *std::min_element(d.prior.begin(), d.prior.end()) >= 0.0 &&
                      *std::max_element(d.prior.begin(), d.prior.end()) > 0.0,
                  "prior of " + d.name + " must be finite, at least 0, and not all 0");
  }
}

QuestDefinition checked(QuestDefinition d) {
  require_table(!d.stimulus.empty(), "stimulus must have a dimension");
  require_table(std::any_of(d.parameters.begin(), d.parameters.end(),
                            [](const QuestDimension& p) { return !p.nuisance; }),
                "parameters must have one that is no nuisance");
  require_table(d.outcomes >= 2 && d.outcomes <= 64, "outcomes must be from 2 to 64");
  require_table(static_cast<bool>(d.model), "model must be given");
  std::for_each(d.stimulus.begin(), d.stimulus.end(), check_dimension);
  std::for_each(d.parameters.begin(), d.parameters.end(), check_dimension);
  return d;
}

std::size_t size_of(const Dimensions& dimensions) {
  std::size_t size = 1;
  for (const QuestDimension& dimension : dimensions) {
    size *= dimension.values.size();
    require_table(size <= 1'000'000'000, "the grid must not have more than 1000000000 points");
  }
  return size;
}

/// The place in each dimension, the last fastest.
std::vector<std::size_t> places(const Dimensions& dimensions, std::size_t index) {
  std::vector<std::size_t> places(dimensions.size());
  for (std::size_t d = dimensions.size(); d-- > 0;) {
    places[d] = index % dimensions[d].values.size();
    index /= dimensions[d].values.size();
  }
  return places;
}

std::vector<double> values_at(const Dimensions& dimensions, std::size_t index) {
  const auto at = places(dimensions, index);
  std::vector<double> values(dimensions.size());
  for (std::size_t d = 0; d < values.size(); ++d) {
    values[d] = dimensions[d].values[at[d]];
  }
  return values;
}

std::string values_of(const Dimensions& dimensions, const std::vector<double>& values) {
  std::string words;
  for (std::size_t d = 0; d < values.size(); ++d) {
    words += fmt::format("{}{} = {:.6g}", d == 0 ? "" : ", ", dimensions[d].name, values[d]);
  }
  return words;
}

void check_probabilities(const std::vector<double>& p, const QuestDefinition& definition,
                         const std::vector<double>& stimulus,
                         const std::vector<double>& parameters) {
  const double sum = std::accumulate(p.begin(), p.end(), 0.0);
  const bool proper = std::all_of(p.begin(), p.end(), [](double v) { return v >= 0.0; });
  if (!proper || !(std::abs(sum - 1.0) <= 1e-9)) {
    throw std::invalid_argument(fmt::format(
        "the probabilities of the answers 0 to {} are {:.4g} for {} and {}; allowed: numbers "
        "from 0 to 1 with the sum 1",
        p.size() - 1, fmt::join(p, ", "), values_of(definition.stimulus, stimulus),
        values_of(definition.parameters, parameters)));
  }
}

}  // namespace

QuestTables::QuestTables(QuestDefinition definition)
    : definition_(checked(std::move(definition))),
      stimuli_(size_of(definition_.stimulus)),
      cells_(size_of(definition_.parameters)),
      padded_((cells_ + kColumns - 1) / kColumns * kColumns) {
  exact_.resize(stimuli_ * (outcomes() + 1) * cells_);
  single_.resize(stimuli_ * outcomes() * padded_);
  std::fill(single_.begin(), single_.end(), 0.0f);
  for (std::size_t s = 0; s < stimuli_; ++s) {
    fill(s);
  }
  fill_prior();
  fill_groups();
}

void QuestTables::fill(std::size_t stimulus_index) {
  const auto at = stimulus(stimulus_index);
  std::vector<double> p(outcomes());
  double* exact = exact_.data() + stimulus_index * (outcomes() + 1) * cells_;
  float* single = single_.data() + stimulus_index * outcomes() * padded_;
  const auto put = [&](std::size_t row, std::size_t single_row, std::size_t c, double value) {
    exact[row * cells_ + c] = value;
    if (single_row < outcomes()) {
      single[single_row * padded_ + c] =
          value < kLeastProbability ? 0.0f : static_cast<float>(value);
    }
  };
  for (std::size_t c = 0; c < cells_; ++c) {
    definition_.model(at.data(), parameters(c).data(), p.data());
    check_probabilities(p, definition_, at, parameters(c));
    double h = 0.0;
    for (std::size_t o = 0; o < p.size(); ++o) {
      h += surprise(p[o]);
      put(o, o + 1 < p.size() ? o : p.size(), c, p[o]);
    }
    put(p.size(), p.size() - 1, c, h);
  }
}

void QuestTables::fill_prior() {
  prior_.resize(cells_);
  for (std::size_t c = 0; c < cells_; ++c) {
    const auto at = places(definition_.parameters, c);
    prior_[c] = 1.0;
    for (std::size_t d = 0; d < at.size(); ++d) {
      const auto& prior = definition_.parameters[d].prior;
      prior_[c] *= prior.empty() ? 1.0 : prior[at[d]];
    }
  }
  const double sum = std::accumulate(prior_.begin(), prior_.end(), 0.0);
  require_table(sum > 0.0 && std::isfinite(sum), "the priors must have a product that is a number");
  for (double& p : prior_) {
    p /= sum;
  }
}

void QuestTables::fill_groups() {
  const Dimensions& parameters = definition_.parameters;
  if (std::none_of(parameters.begin(), parameters.end(),
                   [](const auto& p) { return p.nuisance; })) {
    return;
  }
  groups_.resize(cells_);
  for (std::size_t c = 0; c < cells_; ++c) {
    const auto at = places(parameters, c);
    std::size_t group = 0;
    for (std::size_t d = 0; d < at.size(); ++d) {
      group = parameters[d].nuisance ? group : group * parameters[d].values.size() + at[d];
    }
    groups_[c] = group;
    group_count_ = std::max(group_count_, group + 1);
  }
}

std::vector<double> QuestTables::stimulus(std::size_t index) const {
  return values_at(definition_.stimulus, index);
}

std::vector<double> QuestTables::parameters(std::size_t cell) const {
  return values_at(definition_.parameters, cell);
}

const double* QuestTables::likelihood(std::size_t stimulus, std::size_t outcome) const noexcept {
  return exact_.data() + (stimulus * (outcomes() + 1) + outcome) * cells_;
}

std::vector<double> QuestTables::likelihood_at(const std::vector<double>& stimulus,
                                               std::size_t outcome) const {
  std::vector<double> likelihood(cells_);
  std::vector<double> p(outcomes());
  for (std::size_t c = 0; c < cells_; ++c) {
    definition_.model(stimulus.data(), parameters(c).data(), p.data());
    check_probabilities(p, definition_, stimulus, parameters(c));
    likelihood[c] = p[outcome];
  }
  return likelihood;
}

const float* QuestTables::rows(std::size_t stimulus) const noexcept {
  return single_.data() + stimulus * outcomes() * padded_;
}

}  // namespace haptrial::psychometric
