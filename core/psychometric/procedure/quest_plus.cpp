#include "core/psychometric/procedure/quest_plus.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptrial::psychometric {
namespace {

constexpr const char* kQuest = "QuestPlus";

std::shared_ptr<const QuestTables> given(std::shared_ptr<const QuestTables> tables) {
  checks::require(tables != nullptr, kQuest, "tables must be given");
  return tables;
}

/// The place of a cell in one dimension of the parameters.
std::size_t place_of(const std::vector<QuestDimension>& dimensions, std::size_t dimension,
                     std::size_t cell) {
  for (std::size_t d = dimensions.size() - 1; d > dimension; --d) {
    cell /= dimensions[d].values.size();
  }
  return cell % dimensions[dimension].values.size();
}

/// Value at which a posterior's distribution is `share`: each value stands for what lies around it,
/// up to halfway to its neighbours; nothing lies beyond the first and the last.
double quantile_of(const std::vector<double>& values, const std::vector<double>& shares,
                   double share) {
  const std::size_t last = values.size() - 1;
  double below = 0.0;
  for (std::size_t i = 0; i <= last; ++i) {
    const double before = i > 0 ? values[i] - values[i - 1] : values[1] - values[0];
    const double after = i < last ? values[i + 1] - values[i] : before;
    if (below + shares[i] >= share && shares[i] > 0.0) {
      const double at =
          values[i] - 0.5 * before + 0.5 * (before + after) * (share - below) / shares[i];
      return std::clamp(at, values[0], values[last]);
    }
    below += shares[i];
  }
  return values[last];
}

/// The central 95 %, open where the list of values ends it.
void add_interval(const std::vector<double>& values, const std::vector<double>& shares,
                  Estimate& estimate) {
  constexpr double kTail = 0.025, kNotRejected = 0.15;
  const double limit = kNotRejected * *std::max_element(shares.begin(), shares.end());
  const bool low = shares.front() > limit, high = shares.back() > limit;
  if (low && high) {
    estimate.remark = "not told by the answers";
    return;
  }
  constexpr double kOpen = std::numeric_limits<double>::infinity();
  const bool low_open = low && values.front() != 0.0;
  estimate.interval = {low_open ? -kOpen : quantile_of(values, shares, kTail),
                       high ? kOpen : quantile_of(values, shares, 1.0 - kTail)};
  if (low_open || high) {
    estimate.remark = "cut off by its list of values";
  }
}

}  // namespace

QuestPlus::QuestPlus(std::shared_ptr<const QuestTables> tables, const QuestStop& stop)
    : tables_(given(std::move(tables))),
      stop_(stop),
      selection_(*tables_),
      posterior_(tables_->prior()) {
  checks::require(stop.trials >= 0, kQuest, "stop trials must be at least 0");
  checks::require(stop.entropy >= 0.0, kQuest, "stop entropy must be at least 0");
  checks::require(stop.trials > 0 || stop.entropy > 0.0, kQuest,
                  "stop trials or stop entropy must be above 0");
  choose();
}

const Level& QuestPlus::next() const {
  checks::require_running(!finished(), kQuest);
  return next_;
}

bool QuestPlus::finished() const { return sure_ || (stop_.trials > 0 && trials_ >= stop_.trials); }

void QuestPlus::report(double answer, const Level& applied) {
  checks::require_running(!finished(), kQuest);
  const std::size_t outcome = checks::outcome_of(answer, tables_->outcomes(), kQuest);
  checks::require(applied.size() == next_.size() &&
                      std::all_of(applied.begin(), applied.end(),
                                  [](double level) { return std::isfinite(level); }),
                  kQuest, "applied must have a finite number for each dimension of the stimulus");
  std::vector<double> off_grid;
  const double* likelihood = tables_->likelihood(index_, outcome);
  if (applied != next_) {
    off_grid = tables_->likelihood_at(applied, outcome);
    likelihood = off_grid.data();
  }
  const double sum = row_sum(likelihood, posterior_.size(), posterior_.data());
  // An answer that no parameters allow, as without lapses, tells nothing of them: people slip.
  for (std::size_t c = 0; sum > 0.0 && c < posterior_.size(); ++c) {
    posterior_[c] *= likelihood[c] / sum;
  }
  ++trials_;
  choose();
}

void QuestPlus::choose() {
  sure_ = stop_.entropy > 0.0 && entropy() <= stop_.entropy;
  if (!finished()) {
    index_ = selection_.best(*tables_, posterior_);
    next_ = tables_->stimulus(index_);
  }
}

double QuestPlus::entropy() const {
  double entropy = 0.0;
  for (double p : posterior_) {
    entropy -= p > 0.0 ? p * std::log(p) : 0.0;
  }
  return entropy;
}

std::vector<double> QuestPlus::marginal(std::size_t parameter) const {
  const auto& dimensions = tables_->definition().parameters;
  checks::require(parameter < dimensions.size(), kQuest, "parameter must be one of the definition");
  std::vector<double> shares(dimensions[parameter].values.size());
  for (std::size_t c = 0; c < posterior_.size(); ++c) {
    shares[place_of(dimensions, parameter, c)] += posterior_[c];
  }
  return shares;
}

std::optional<LevelRange> QuestPlus::range() const {
  const auto [low, high] = std::ranges::minmax(tables_->definition().stimulus.front().values);
  return LevelRange{low, high};
}

std::vector<Estimate> QuestPlus::estimates() const {
  const auto& dimensions = tables_->definition().parameters;
  const auto top = std::max_element(posterior_.begin(), posterior_.end()) - posterior_.begin();
  const auto mode = tables_->parameters(static_cast<std::size_t>(top));
  std::vector<Estimate> means;
  std::vector<Estimate> modes;
  for (std::size_t d = 0; d < dimensions.size(); ++d) {
    const auto& values = dimensions[d].values;
    if (values.size() < 2) {
      continue;
    }
    const auto shares = marginal(d);
    double mean = 0.0;
    double square = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      mean += shares[i] * values[i];
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
      square += shares[i] * (values[i] - mean) * (values[i] - mean);
    }
    means.push_back({dimensions[d].name + ", mean of the posterior", mean, std::sqrt(square)});
    add_interval(values, shares, means.back());
    modes.push_back({dimensions[d].name + ", mode of the posterior", mode[d], std::nullopt});
  }
  means.insert(means.end(), modes.begin(), modes.end());
  return means;
}

}  // namespace haptrial::psychometric
