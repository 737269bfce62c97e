#include "analysis/psychophysics/study/produced_quantities.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "analysis/psychophysics/data/trials_data.h"
#include "analysis/psychophysics/fit/series.h"
#include "analysis/statistics/base/descriptive.h"
#include "core/base/parallel.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/device_row.h"

namespace haptrial::analysis::trials {
namespace {

double value_of(const ProducedTick& tick, ProducedQuantity quantity) {
  switch (quantity) {
    case ProducedQuantity::kForce:
      return tick.force.norm();
    case ProducedQuantity::kX:
      return tick.position.x();
    case ProducedQuantity::kY:
      return tick.position.y();
    case ProducedQuantity::kZ:
      return tick.position.z();
    case ProducedQuantity::kSpeed:
      return tick.velocity.norm();
    case ProducedQuantity::kPath:
      break;
  }
  return 0.0;
}

double path_of(std::span<const ProducedTick> ticks) {
  double way = 0.0;
  for (std::size_t i = 1; i < ticks.size(); ++i) {
    way += (ticks[i].position - ticks[i - 1].position).norm();
  }
  return way;
}

/// Reads what the trials of one session produced.
class SessionProducts {
 public:
  SessionProducts(const std::filesystem::path& file, const ProducedPlan& plan)
      : reader_(file), plan_(plan) {
    if (plan.device > 0) {
      rows_ = reader_.rows<record::DeviceRow>();
      std::erase_if(rows_,
                    [&](const auto& row) { return !std::cmp_equal(row.device, plan.device); });
    }
  }

  std::optional<double> of(const StudyTrial& trial) const {
    const StageTime* stage = last_stage(trial, plan_.stage);
    if (stage == nullptr || stage->ticks == 0) {
      return std::nullopt;
    }
    const std::uint64_t end = trial.first_sample + stage->first + stage->ticks;
    std::uint64_t count = stage->ticks;
    if (plan_.last > 0.0) {
      const auto last = std::lround(plan_.last * reader_.info().rate);
      count = std::min(count, static_cast<std::uint64_t>(std::max(1L, last)));
    }
    const std::vector<ProducedTick> ticks = ticks_from(end - count, count);
    return ticks.empty() ? std::nullopt : std::optional(produced_value(ticks, plan_));
  }

 private:
  std::vector<ProducedTick> ticks_from(std::uint64_t first, std::uint64_t count) const {
    std::vector<ProducedTick> ticks;
    if (plan_.device == 0) {
      for (const record::Sample& sample : reader_.samples(first, count)) {
        ticks.push_back({sample.position, sample.velocity, sample.force});
      }
      return ticks;
    }
    auto row = std::ranges::lower_bound(rows_, first, {}, &record::DeviceRow::sequence);
    for (; row != rows_.end() && row->sequence < first + count; ++row) {
      ticks.push_back({row->position, row->velocity, row->force});
    }
    return ticks;
  }

  record::SessionReader reader_;
  const ProducedPlan& plan_;
  std::vector<record::DeviceRow> rows_;  // of the device, if it is not the first
};

/// Values of the trials of a participant under a condition.
struct Products {
  std::vector<double> values, errors;
};
using Cells = std::map<std::pair<std::string, std::vector<std::string>>, Products>;

/// @param sizes  whether signs do not count
double mean_of_all(const std::vector<double>& values, bool sizes) {
  double sum = 0.0;
  for (const double value : values) {
    sum += sizes ? std::abs(value) : value;
  }
  return sum / static_cast<double>(values.size());
}

/// A quantity of those cells for which the value is defined.
template <class Value>
Quantity quantity_of(const Cells& cells, const char* name, const std::string& title,
                     const TrialsPlan& plan, ValueRange range, Value value) {
  std::vector<QuantityValue> all;
  for (const auto& [of, cell] : cells) {
    if (const std::optional<double> one = value(cell)) {
      all.push_back({of.first, of.second, *one});
    }
  }
  return quantity(name, title, unit_of(plan.produced.quantity), all, plan, range);
}

std::vector<Quantity> produced_by_condition(const Cells& cells, const TrialsPlan& plan) {
  const auto mean = [](const std::vector<double>& of, bool sizes) {
    return of.empty() ? std::nullopt : std::optional(mean_of_all(of, sizes));
  };
  std::vector<Quantity> all{quantity_of(cells, "produced", words_of(plan.produced), plan,
                                        ValueRange::kAny,
                                        [&](const Products& p) { return mean(p.values, false); })};
  if (plan.produced.target.empty()) {
    return all;
  }
  all.push_back(quantity_of(cells, "constant_error", "constant error", plan, ValueRange::kAny,
                            [&](const Products& p) { return mean(p.errors, false); }));
  all.push_back(quantity_of(cells, "absolute_error", "absolute error", plan, ValueRange::kPositive,
                            [&](const Products& p) { return mean(p.errors, true); }));
  all.push_back(quantity_of(cells, "variable_error", "variable error", plan, ValueRange::kPositive,
                            [](const Products& p) -> std::optional<double> {
                              const auto m = moments(p.errors);
                              return m && m->count > 1 ? std::optional(std::sqrt(m->variance()))
                                                       : std::nullopt;
                            }));
  return all;
}

}  // namespace

double produced_value(std::span<const ProducedTick> ticks, const ProducedPlan& plan) {
  if (plan.quantity == ProducedQuantity::kPath) {
    return path_of(ticks);
  }
  std::vector<double> values;
  for (const ProducedTick& tick : ticks) {
    values.push_back(value_of(tick, plan.quantity));
  }
  switch (plan.statistic) {
    case ProducedStatistic::kMean:
      return mean_of_all(values, false);
    case ProducedStatistic::kPeak:
      return *std::ranges::max_element(values, {}, [](double v) { return std::abs(v); });
    case ProducedStatistic::kEnd:
      return values.back();
    case ProducedStatistic::kDeviation:
      break;
  }
  const Moments m = *moments(values);
  return std::sqrt(m.squares / static_cast<double>(m.count));
}

std::vector<Quantity> produced_quantities(const TrialsData& data,
                                          const std::vector<std::filesystem::path>& files,
                                          const TrialsPlan& plan, int threads) {
  std::vector<std::optional<double>> values(data.trials.size());
  parallel_for(files.size(), threads_or_all(threads), [&](std::size_t session) {
    const SessionProducts products(files[session], plan.produced);
    for (std::size_t i = 0; i < data.trials.size(); ++i) {
      if (data.trials[i].session == session && data.trials[i].counts()) {
        values[i] = products.of(data.trials[i]);
      }
    }
  });
  Cells cells;
  for (std::size_t i = 0; i < data.trials.size(); ++i) {
    if (!values[i]) {
      continue;
    }
    const StudyTrial& trial = data.trials[i];
    Products& cell = cells[{data.session_of(trial).participant, factors_of(data, trial, plan)}];
    cell.values.push_back(*values[i]);
    const GivenVariable* target = variable_of(trial, plan.produced.target);
    if (target != nullptr && std::isfinite(target->value)) {
      cell.errors.push_back(*values[i] - target->value);
    }
  }
  return produced_by_condition(cells, plan);
}

}  // namespace haptrial::analysis::trials
