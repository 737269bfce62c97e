#include "analysis/force_training/study/recall_frequency.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>

#include "analysis/statistics/base/p_adjust.h"

namespace haptrial::analysis {
namespace {

using Complex = std::complex<double>;

constexpr std::size_t kInstants = 1024;  // of a run
constexpr double kLeastPower = 0.01;     // of the taught patterns, for a band
constexpr double kLeastResponse = 1e-9;  // below it nothing came back, which has no phase

std::vector<Complex> coefficients_of(const std::vector<double>& curve) {
  const double mean =
      std::accumulate(curve.begin(), curve.end(), 0.0) / static_cast<double>(curve.size());
  std::vector<Complex> found(kRecallCycles);
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const double angle =
        2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(curve.size());
    const double windowed = (0.5 - 0.5 * std::cos(angle)) * (curve[i] - mean);
    const Complex turn = std::polar(1.0, -angle);
    Complex wave = turn;
    for (Complex& each : found) {
      each += windowed * wave;
      wave *= turn;
    }
  }
  return found;
}

/// A participant adds this to a band under a condition.
struct BandValue {
  const RecalledSpectra* of{nullptr};
  RecallResponse response;
};

/// An angle between -pi and pi.
double wrapped(double angle) { return std::remainder(angle, 2.0 * std::numbers::pi); }

double fisher_z(double coherence) {
  return std::atanh(std::sqrt(std::min(coherence, 1.0 - 1e-12)));
}

/// An interval of other values, such as logarithms, as one of the values.
template <class Back>
Defined<MeanInterval> turned_back(const Defined<MeanInterval>& of, Back back) {
  return of ? Defined<MeanInterval>(MeanInterval{of->count, back(of->mean), of->deviation,
                                                 back(of->low), back(of->high)})
            : of;
}

Defined<MeanInterval> gain_of(const std::vector<BandValue>& values) {
  std::vector<double> logs;
  for (const BandValue& each : values) {
    logs.push_back(std::log(std::abs(each.response.response)));
  }
  return turned_back(mean_interval(logs), [](double x) { return std::exp(x); });
}

Defined<MeanInterval> coherence_of(const std::vector<BandValue>& values) {
  std::vector<double> z;
  for (const BandValue& each : values) {
    z.push_back(fisher_z(each.response.coherence));
  }
  return turned_back(mean_interval(z), [](double x) { return std::pow(std::tanh(x), 2.0); });
}

/// The mean direction of phases; nothing if Rayleigh's test does not reject that they point
/// everywhere alike.
std::optional<double> direction_of(const std::vector<BandValue>& values) {
  Complex sum{0.0};
  for (const BandValue& each : values) {
    const double size = std::abs(each.response.response);
    sum += size > 0.0 ? each.response.response / size : Complex(0.0);
  }
  constexpr double kRayleigh = 2.9957;  // -ln 0.05, of n times the squared mean length
  const auto n = static_cast<double>(values.size());
  return n > 0.0 && std::norm(sum) / n > kRayleigh ? std::optional(std::arg(sum)) : std::nullopt;
}

Defined<MeanInterval> phase_of(const std::vector<BandValue>& values) {
  const auto middle = direction_of(values);
  if (!middle) {
    return Undefined{"participants' phases have no common direction"};
  }
  std::vector<double> beside;
  for (const BandValue& each : values) {
    beside.push_back(wrapped(std::arg(each.response.response) - *middle));
  }
  return turned_back(mean_interval(beside), [&](double x) { return *middle + x; });
}

RecallAtFrequency at_frequency(const std::string& condition, const std::vector<BandValue>& values) {
  RecallAtFrequency found{condition, values.size()};
  for (const BandValue& each : values) {
    found.trials += static_cast<double>(each.response.trials) / static_cast<double>(values.size());
  }
  if (!values.empty()) {
    found.gain = gain_of(values);
    found.phase = phase_of(values);
    found.coherence = coherence_of(values);
  }
  return found;
}

/// A number of each participant who has it under every condition (participants x conditions).
template <class Value>
std::vector<std::vector<double>> complete_table(
    const std::vector<std::vector<BandValue>>& by_condition, Value value) {
  std::map<std::string, std::vector<double>> rows;
  for (std::size_t c = 0; c < by_condition.size(); ++c) {
    for (const BandValue& each : by_condition[c]) {
      std::vector<double>& row = rows[each.of->subject];
      if (row.size() == c) {
        row.push_back(value(each.response));
      }
    }
  }
  std::vector<std::vector<double>> table;
  for (auto& [subject, row] : rows) {
    if (row.size() == by_condition.size()) {
      table.push_back(std::move(row));
    }
  }
  return table;
}

void test_band(const std::vector<std::vector<BandValue>>& by_condition, RecallBand& band) {
  band.gain.anova = repeated_measures_anova(complete_table(
      by_condition, [](const RecallResponse& r) { return std::log(std::abs(r.response)); }));
  band.coherence.anova = repeated_measures_anova(
      complete_table(by_condition, [](const RecallResponse& r) { return fisher_z(r.coherence); }));
  std::vector<BandValue> all;
  for (const auto& values : by_condition) {
    all.insert(all.end(), values.begin(), values.end());
  }
  const auto middle = direction_of(all);
  band.phase.anova =
      middle
          ? repeated_measures_anova(complete_table(
                by_condition,
                [&](const RecallResponse& r) { return wrapped(std::arg(r.response) - *middle); }))
          : Undefined{"participants' phases have no common direction"};
}

/// Holm's p over the bands, of one number.
void adjust(std::vector<RecallBand>& bands, RecallTest RecallBand::*test) {
  struct Corrected {
    double p{1.0};
  };
  std::vector<Defined<Corrected>> all;
  for (const RecallBand& band : bands) {
    const Defined<RepeatedAnova>& anova = (band.*test).anova;
    all.push_back(anova ? Defined<Corrected>(Corrected{anova->p_corrected})
                        : Undefined{anova.because()});
  }
  const std::vector<Defined<double>> adjusted = holm_over(all);
  for (std::size_t i = 0; i < bands.size(); ++i) {
    (bands[i].*test).p_adjusted = adjusted[i];
  }
}

/// The share of each cycle in the power of all taught patterns.
std::vector<double> taught_power(std::span<const RecalledSpectra> spectra) {
  std::vector<double> power(kRecallCycles, 0.0);
  for (const RecalledSpectra& each : spectra) {
    for (const RecallSpectrum* recall : each.recalls) {
      for (std::size_t k = 0; k < kRecallCycles; ++k) {
        power[k] += std::norm(recall->target[k]);
      }
    }
  }
  const double sum = std::accumulate(power.begin(), power.end(), 0.0);
  for (double& each : power) {
    each = sum > 0.0 ? each / sum : 0.0;
  }
  return power;
}

/// How long a cycle a run takes in each recall [s].
std::vector<double> periods_of(std::span<const RecalledSpectra> spectra) {
  std::vector<double> periods;
  for (const RecalledSpectra& each : spectra) {
    for (const RecallSpectrum* recall : each.recalls) {
      periods.push_back(recall->period);
    }
  }
  return periods;
}

RecallBand band_of(std::span<const RecalledSpectra> spectra,
                   const std::vector<std::string>& conditions, std::size_t cycle) {
  RecallBand band;
  std::vector<std::vector<BandValue>> by_condition;
  for (const std::string& condition : conditions) {
    std::vector<BandValue>& values = by_condition.emplace_back();
    for (const RecalledSpectra& each : spectra) {
      if (each.condition == condition && each.recalls.size() > 1) {
        const RecallResponse response = recall_response(each.recalls, cycle);
        if (std::abs(response.response) > kLeastResponse) {
          values.push_back({&each, response});
        }
      }
    }
    band.conditions.push_back(at_frequency(condition, values));
  }
  test_band(by_condition, band);
  return band;
}

}  // namespace

RecallSpectrum recall_spectrum(const ForceCurve& target, const ForceCurve& applied) {
  return recall_spectrum(view(target), view(applied));
}

RecallSpectrum recall_spectrum(const SampledCurve& target, const SampledCurve& applied) {
  const double duration = std::max(duration_of(target, "target"), duration_of(applied, "applied"));
  const TimeBase base{duration, kInstants};
  return {coefficients_of(resample(target, base)), coefficients_of(resample(applied, base)),
          base.step() * static_cast<double>(kInstants)};
}

std::vector<RecalledSpectra> recalled_spectra(std::span<const TrialScore> scores,
                                              std::span<const RecallSpectrum> spectra) {
  std::map<std::pair<std::string, std::string>, RecalledSpectra> cells;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    RecalledSpectra& cell = cells[{scores[i].subject, scores[i].condition}];
    cell.subject = scores[i].subject;
    cell.condition = scores[i].condition;
    cell.recalls.push_back(&spectra[i]);
  }
  std::vector<RecalledSpectra> all;
  for (auto& [of, cell] : cells) {
    all.push_back(std::move(cell));
  }
  return all;
}

RecallResponse recall_response(std::span<const RecallSpectrum* const> recalls, std::size_t cycle) {
  Complex cross{0.0};
  double taught = 0.0, recalled = 0.0;
  for (const RecallSpectrum* each : recalls) {
    cross += std::conj(each->target[cycle]) * each->applied[cycle];
    taught += std::norm(each->target[cycle]);
    recalled += std::norm(each->applied[cycle]);
  }
  RecallResponse found{0.0, 0.0, recalls.size()};
  found.response = taught > 0.0 ? cross / taught : Complex(0.0);
  found.coherence = taught > 0.0 && recalled > 0.0 ? std::norm(cross) / (taught * recalled) : 0.0;
  return found;
}

Defined<std::vector<RecallBand>> recall_over_time(std::span<const RecalledSpectra> spectra,
                                                  const std::vector<std::string>& conditions) {
  constexpr double kAlike = 1.1;  // the longest run over the shortest
  const std::vector<double> periods = periods_of(spectra);
  if (!periods.empty()) {
    const auto [shortest, longest] = std::ranges::minmax(periods);
    if (longest > kAlike * shortest) {
      return Undefined{fmt::format(
          "runs take {:.3g} to {:.3g} s, so that their cycles are different frequencies", shortest,
          longest)};
    }
  }
  return recall_by_frequency(spectra, conditions);
}

std::vector<RecallBand> recall_by_frequency(std::span<const RecalledSpectra> spectra,
                                            const std::vector<std::string>& conditions) {
  std::vector<RecallBand> bands;
  const std::vector<double> periods = periods_of(spectra);
  const double period =
      std::accumulate(periods.begin(), periods.end(), 0.0) / static_cast<double>(periods.size());
  const std::vector<double> power = taught_power(spectra);
  for (std::size_t k = 0; k < kRecallCycles; ++k) {
    if (power[k] >= kLeastPower) {
      RecallBand band = band_of(spectra, conditions, k);
      band.frequency = static_cast<double>(k + 1) / period;
      band.power = power[k];
      bands.push_back(std::move(band));
    }
  }
  for (RecallTest RecallBand::*test :
       {&RecallBand::gain, &RecallBand::phase, &RecallBand::coherence}) {
    adjust(bands, test);
  }
  return bands;
}

std::vector<std::pair<std::string, std::size_t>> notable(const std::vector<TrialScore>& scores) {
  if (scores.empty()) {
    return {};
  }
  std::vector<std::size_t> order(scores.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return scores[a].score < scores[b].score; });
  return {
      {"best", order.front()}, {"median", order[(order.size() - 1) / 2]}, {"worst", order.back()}};
}

RecallPicture recall_picture(const std::string& which, const TrialScore& score,
                             RecallDetail detail) {
  RecallPicture picture{which,
                        score,
                        detail.time.duration,
                        std::move(detail.target),
                        std::move(detail.applied),
                        std::move(detail.warped)};
  for (const auto& point : detail.path) {
    picture.pairs.emplace_back(point.target, point.applied);
  }
  return picture;
}

}  // namespace haptrial::analysis
