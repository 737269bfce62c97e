#pragma once

#include <cstdint>
#include <filesystem>

#include "analysis/psychophysics/data/trials_data.h"
#include "analysis/psychophysics/fit/trials_plan.h"

namespace haptrial::test {

enum class SimulatedTask {
  kStaircase,   // two intervals, two interleaved staircases, Weibull of the difference to 300 N/m
  kConstant,    // two intervals, constant stimuli, likewise
  kComparison,  // "larger" or "smaller" than 10 N, constant stimuli, cumulative Gaussian
  kDetection,   // yes or no with a rating from 1 to 3, half of the trials with signal
  kMagnitude,   // numbers for five levels
  kIdentification,  // which of four shapes it is, with a rating from 1 to 3
  kTimes,           // left or right, in a time that grows by 50 ms with each of four levels
};

/// A study at the level of answers, without a servo loop. Two conditions, "off" and "on" of the
/// factor light, within participants; in half of them "on" comes first.
struct SimulatedTrials {
  SimulatedTask task{SimulatedTask::kStaircase};
  int participants{12};
  int conditions{2};         // 1 or 2
  int trials{80};            // of each condition
  double spread{0.15};       // standard deviation of people: of log threshold, of the point of
                             // equality in N, of d', of the exponent
  double interaction{0.05};  // the same of a person's difference between the conditions
  double effect{0.0};        // of "on", likewise
  double repetition{0.0};    // of ResponseObserver
  double drift{0.0};         // likewise
  std::uint64_t seed{1};
};

/// Typical threshold (log difference), point, d' and exponent of the people of such a study.
inline constexpr double kTypicalLogThreshold = 3.4;  // 30 N/m above 300
inline constexpr double kTypicalPoint = 10.0;        // [N]
inline constexpr double kTypicalDPrime = 1.5;
inline constexpr double kTypicalExponent = 1.1;

analysis::trials::TrialsData simulated_trials(const SimulatedTrials& study);

/// The plan that such a study's definition would state.
analysis::trials::TrialsPlan plan_of(const SimulatedTrials& study);

/// Writes the sessions of a study as the program does, "P01.h5", ...; each trial has `ticks`
/// samples at 1 kHz. @param definition  text of the file
void write_sessions(const analysis::trials::TrialsData& data, const std::filesystem::path& folder,
                    int ticks, const std::string& definition = "# made by hand\n");

}  // namespace haptrial::test
