#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis/force_training/score/resample.h"
#include "analysis/force_training/score/score.h"
#include "analysis/force_training/score/trial_score.h"
#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/variance/repeated_anova.h"

namespace haptrial::analysis {

/// Fourier coefficients of both curves of a recall, at 1, 2, … cycles of the run: each curve less
/// its mean, under a Hann window as long as the run.
struct RecallSpectrum {
  std::vector<std::complex<double>> target, applied;  // (kRecallCycles) [N]
  double period{0.0};                                 // of one cycle a run [s]
};

/// Most cycles of a run that are looked at.
inline constexpr std::size_t kRecallCycles = 12;

/// @throws InputError for a curve that duration_of() refuses
RecallSpectrum recall_spectrum(const SampledCurve& target, const SampledCurve& applied);
RecallSpectrum recall_spectrum(const ForceCurve& target, const ForceCurve& applied);

/// The recalls of one participant under one condition.
struct RecalledSpectra {
  std::string subject;
  std::string condition;
  std::vector<const RecallSpectrum*> recalls;  // not null; outlive the call
};

/// The recalls of each participant under each condition. @param spectra  (scores); outlive the
/// result
std::vector<RecalledSpectra> recalled_spectra(std::span<const TrialScore> scores,
                                              std::span<const RecallSpectrum> spectra);

/// How the taught force came back at a frequency, over the trials of a participant under a
/// condition: H = Sxy / Sxx and coherence |Sxy|² / (Sxx Syy), S summed over trials (x taught, y
/// recalled).
struct RecallResponse {
  std::complex<double> response{0.0};
  double coherence{0.0};  // 0 to 1; 1 of a single trial
  std::size_t trials{0};
};

/// @param cycle  from 0, the place among the coefficients
RecallResponse recall_response(std::span<const RecallSpectrum* const> recalls, std::size_t cycle);

/// A condition at a frequency, over participants with at least two trials who recalled something
/// there.
struct RecallAtFrequency {
  std::string condition;
  std::size_t people{0};
  double trials{0.0};  // of a participant, on average
  Defined<MeanInterval> gain{Undefined{"there are no participants"}};       // geometric mean
  Defined<MeanInterval> phase{Undefined{"there are no participants"}};      // < 0: late [rad]
  Defined<MeanInterval> coherence{Undefined{"there are no participants"}};  // mean of Fisher's z
};

/// A test of a number by condition within participants, with Holm's p over the frequencies.
struct RecallTest {
  Defined<RepeatedAnova> anova{Undefined{"nothing was compared"}};
  Defined<double> p_adjusted{Undefined{"nothing was compared"}};  // of p_corrected
};

/// A frequency at which patterns were taught.
struct RecallBand {
  double frequency{0.0};  // [Hz]
  double power{0.0};      // of the taught patterns, as a share of that of all cycles
  std::vector<RecallAtFrequency> conditions;
  RecallTest gain, phase, coherence;  // of their logarithm, angle and Fisher's z
};

/// Recall by frequency: bands that hold at least 1 % of the power of the taught patterns, by rising
/// frequency; none if there are no recalls. Which bands there are follows from the patterns alone.
/// A frequency is that of the mean run.
/// @param spectra     one for each participant under each condition with a recall
/// @param conditions  in the order of the result
/// Source: Morris 2006, §4.3 (curves) and §4.5 (the question); Bendat and Piersol 2010, chapter 9.
std::vector<RecallBand> recall_by_frequency(std::span<const RecalledSpectra> spectra,
                                            const std::vector<std::string>& conditions);

/// Recall by frequency of patterns that stand over time: not defined if runs differ in length by more
/// than a tenth, as a cycle of them is no one frequency. A run at the participant's own pace has
/// its pattern over the path, and differs.
Defined<std::vector<RecallBand>> recall_over_time(std::span<const RecalledSpectra> spectra,
                                                  const std::vector<std::string>& conditions);

/// How one recall was aligned with its target, on the common time base.
/// Source: Morris 2006, §4.3, Figures 26 and 27.
struct RecallPicture {
  std::string which;  // "best", "median" or "worst" of the study
  TrialScore score;
  double duration{0.0};                                      // of the pass [s]
  std::vector<double> target{};                              // (base) [N]
  std::vector<double> applied{};                             // (base) filtered [N]
  std::vector<double> warped{};                              // (base) applied after alignment [N]
  std::vector<std::pair<std::size_t, std::size_t>> pairs{};  // (path) target index, applied index
};

/// The places of the best, the median (the lower of two) and the worst of the scores, with those
/// words; of equal scores the first. None without scores.
std::vector<std::pair<std::string, std::size_t>> notable(const std::vector<TrialScore>& scores);

/// @param which  "best", "median" or "worst"
RecallPicture recall_picture(const std::string& which, const TrialScore& score,
                             RecallDetail detail);

}  // namespace haptrial::analysis
