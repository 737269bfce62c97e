#pragma once

#include <vector>

#include "analysis/contact/evaluation/contact_samples.h"

namespace haptrial::evaluation {

struct StickOptions {
  double least_force{0.2};      // normal force of a contact > 0 [N]
  double slow{0.002};           // below it the contact may stick [m/s]
  double fast{0.010};           // above it the contact slips, > slow [m/s]
  double shortest_stick{0.01};  // [s]
};

/// Ratios at which sticking breaks: |F_t| / F_n for each phase of contact that is slower than
/// `options.slow` for `shortest_stick` or longer and is followed, still in contact, by a sample
/// faster than `options.fast`, before which no sample is slow again. The ratio is negative where
/// F_t points the way that this sample moves, which friction never does. F_t / F_n is the straight
/// line through the last (up to ten) samples of the phase, half a sample after the last one.
/// @param samples  that pass check(); velocities over the period that ends with the sample
std::vector<double> break_away_ratios(const ContactSamples& samples, const StickOptions& options);

}  // namespace haptrial::evaluation
