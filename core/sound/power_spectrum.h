#pragma once

#include <span>
#include <vector>

#include "core/sound/spectrum_table.h"

namespace haptrial::sound {

/// How the mean square of a signal is spread over frequencies: the sum over all bins is the mean
/// square.
struct PowerSpectrum {
  double rate{0.0};           // of the signal [Hz]
  double bin{0.0};            // distance of two bins [Hz]; bin i is at i bin
  int segments{0};            // that were averaged
  std::vector<double> power;  // (segment / 2 + 1) mean squares
};

/// Welch's estimate: the mean over segments that overlap by half, each under a Hann window, from
/// GSL's FFT.
/// @param segment  samples in a segment, a power of two from 16 to the signal's length; 0: 40 ms
///                 or more, shorter where the signal is, for tones that waver
/// @throws std::invalid_argument for another segment, a signal below 16 samples or another rate.
PowerSpectrum power_spectrum(std::span<const float> signal, double rate, int segment = 0);

struct PeakSearch {
  int most{Spectrum::kMaxPeaks};  // peaks, the strongest first, 1 to Spectrum::kMaxPeaks
  double above_floor{0.0};  // power of a peak's bin over the median around it > 1; 0: automatic
  double lowest{40.0};      // [Hz] below lie hum and handling
};

/// The lines of a spectrum by rising frequency, and what is left as noise:
///
///     frequency  centre of gravity of the power above the floor      (a small part of a bin)
///     amplitude  sqrt(2 power above the floor)                       (of the sine)
///     bandwidth  width at half the power, less the window's          (0: narrower than is seen)
///
/// Automatic, a bin is a peak where it is 3 times the floor, and 1 + 12 / sqrt(segments) times
/// where few segments leave the floor ragged. The squares of the noise and of the peaks' root mean
/// squares add up to the whole power.
Spectrum find_peaks(const PowerSpectrum& spectrum, const PeakSearch& search = {});

/// The strongest peak's frequency [Hz]; 0 without peaks.
double dominant(const Spectrum& spectrum);
/// The frequency of which most peaks, by their amplitudes, are multiples: the largest of dominant /
/// n that explains nearly as much as any [Hz]; 0 without peaks.
double fundamental(const Spectrum& spectrum);

}  // namespace haptrial::sound
