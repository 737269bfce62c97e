#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "analysis/force_training/study/recall_frequency.h"
#include "core/base/random.h"

namespace haptrial::analysis::recalled_waves {

/// How forces come back: y(t) = gain x(t - delay) + noise, the noise of the same spectrum as x.
struct WaveSystem {
  double gain{1.0};
  double delay{0.0};         // [s]
  double noise{0.0};         // its amplitude against that of x
  double gain_spread{0.0};   // standard deviation of the logarithm over participants
  double delay_spread{0.0};  // likewise, of the delay [s]
};

/// Recalls of sums of four waves, 1 to 4 cycles a run, with phases and sizes of their own.
class RecalledWaves {
 public:
  static constexpr double kDuration = 6.4;       // of a run [s]
  static constexpr std::size_t kSamples = 1024;  // as the analysis takes them

  RecalledWaves(const std::vector<std::pair<std::string, WaveSystem>>& conditions, int people,
                int trials, std::uint64_t seed) {
    for (int person = 0; person < people; ++person) {
      RandomStream random(seed, fmt::format("person {}", person));
      for (const auto& [condition, system] : conditions) {
        recall(person, condition, person_of(system, random), trials, random);
      }
    }
    collect(static_cast<std::size_t>(trials));
  }

  const std::vector<RecalledSpectra>& spectra() const { return spectra_; }
  const std::vector<std::pair<ForceCurve, ForceCurve>>& curves() const { return curves_; }

 private:
  static constexpr int kWaves = 4;
  using Waves = std::array<std::pair<double, double>, kWaves>;  // size and phase

  static WaveSystem person_of(WaveSystem system, RandomStream& random) {
    system.gain *= std::exp(system.gain_spread * random.normal());
    system.delay += system.delay_spread * random.normal();
    return system;
  }

  static Waves draw(RandomStream& random) {
    Waves waves;
    for (auto& [size, phase] : waves) {
      const double a = random.normal(), b = random.normal();
      size = std::hypot(a, b);
      phase = std::atan2(a, b);
    }
    return waves;
  }

  static double at(const Waves& waves, double time) {
    double value = 0.0;
    for (int k = 0; k < kWaves; ++k) {
      const auto& [size, phase] = waves[static_cast<std::size_t>(k)];
      value += size * std::sin(2.0 * std::numbers::pi * (k + 1) * time / kDuration + phase);
    }
    return value;
  }

  void recall(int person, const std::string& condition, const WaveSystem& system, int trials,
              RandomStream& random) {
    owners_.emplace_back(fmt::format("S{:02}", person + 1), condition);
    for (int trial = 0; trial < trials; ++trial) {
      const Waves taught = draw(random), beside = draw(random);
      std::pair<ForceCurve, ForceCurve> curves;
      curves.first.rate = curves.second.rate = kSamples / kDuration;
      for (std::size_t i = 0; i < kSamples; ++i) {
        const double time = static_cast<double>(i) * kDuration / kSamples;
        curves.first.force.push_back(at(taught, time));
        curves.second.force.push_back(system.gain * at(taught, time - system.delay) +
                                      system.noise * at(beside, time));
      }
      recalls_.push_back(recall_spectrum(curves.first, curves.second));
      if (curves_.size() < kKept) {
        curves_.push_back(std::move(curves));
      }
    }
  }

  void collect(std::size_t trials) {
    for (std::size_t i = 0; i < owners_.size(); ++i) {
      spectra_.push_back({owners_[i].first, owners_[i].second, {}});
      for (std::size_t k = 0; k < trials; ++k) {
        spectra_.back().recalls.push_back(&recalls_[i * trials + k]);
      }
    }
  }

  static constexpr std::size_t kKept = 16;  // curves
  std::vector<std::pair<std::string, std::string>> owners_;
  std::vector<RecallSpectrum> recalls_;
  std::vector<std::pair<ForceCurve, ForceCurve>> curves_;
  std::vector<RecalledSpectra> spectra_;
};

/// How often, in studies without a difference of conditions, tests at 2 cycles a run rejected at
/// 5 %, and intervals at 95 % missed what was planted.
struct RecallNullCounts {
  int studies{0};
  int gain{0}, phase{0}, coherence{0};
  int gain_missed{0}, phase_missed{0};
};

inline RecallNullCounts null_recalls(int studies, std::uint64_t seed) {
  constexpr WaveSystem kSystem{0.7, 0.15, 0.5, 0.2, 0.05};
  constexpr double kPhase = -2.0 * std::numbers::pi * 2.0 / RecalledWaves::kDuration * 0.15;
  RecallNullCounts counts;
  for (; counts.studies < studies; ++counts.studies) {
    const RecalledWaves waves({{"a", kSystem}, {"b", kSystem}, {"c", kSystem}}, 10, 6,
                              derived_seed(seed, fmt::format("study {}", counts.studies)));
    const RecallBand band = recall_by_frequency(waves.spectra(), {"a", "b", "c"}).at(1);
    const auto rejects = [](const RecallTest& test) {
      return test.anova && test.anova->p_corrected < 0.05 ? 1 : 0;
    };
    counts.gain += rejects(band.gain);
    counts.phase += rejects(band.phase);
    counts.coherence += rejects(band.coherence);
    const auto misses = [](const Defined<MeanInterval>& interval, double truth) {
      return interval->low <= truth && truth <= interval->high ? 0 : 1;
    };
    counts.gain_missed += misses(band.conditions[0].gain, kSystem.gain);
    counts.phase_missed += misses(band.conditions[0].phase, kPhase);
  }
  return counts;
}

}  // namespace haptrial::analysis::recalled_waves
