#pragma once

#include <optional>
#include <vector>

#include "analysis/device/certificate_record.h"
#include "analysis/device/interval.h"

namespace haptrial::analysis {

/// Response of the measured force to the commanded one at one frequency.
struct ToneResponse {
  double frequency;  // [Hz]
  Interval gain;
  Interval phase;  // [rad], unwrapped from the lowest frequency on
};

/// Response along one axis, and the model
///
///     H = gain · exp(-2 pi i f delay) · R(f)
///
/// with R the held command through a resonance of second order, if the response shows one.
struct AxisResponse {
  std::vector<ToneResponse> tones;
  Interval gain;
  Interval delay;                     // from a command to the beginning of its force [s]
  std::optional<Interval> resonance;  // natural frequency of the second order [Hz]
  std::optional<Interval> damping;    // share of critical damping
  std::optional<Interval> bandwidth;  // gain falls to 1/√2 of that at rest [Hz]
};

/// Frequency at which a second order falls to 1/√2 of its gain at rest, over its natural one.
/// @param damping  share of critical damping
double bandwidth_per_resonance(double damping);

/// Response along each driven axis.
/// @param record  with a sensor in kFrequency
std::vector<AxisResponse> identify_frequency_response(const CertificateRecord& record,
                                                      const Excitation& excitation);

}  // namespace haptrial::analysis
