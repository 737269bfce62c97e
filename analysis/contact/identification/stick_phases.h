#pragma once

#include <vector>

#include "analysis/contact/identification/identify_contact.h"

namespace haptrial::evaluation {

/// Where sticking breaks: |F_t| / F_n for each phase of contact that is slower than `options.slow`
/// for `shortest_stick` or longer and is followed, still in contact, by a sample faster than
/// `options.fast`, before which no sample is slow again. The ratio is negative where F_t points the
/// way that this sample moves, which friction never does. F_t / F_n is the straight line through
/// the last (up to ten) samples of the phase, half a sample after the last one.
/// @param samples  that pass check(); velocities over the period that ends with the sample
std::vector<double> break_away_ratios(const ContactSamples& samples,
                                      const IdentificationOptions& options);

}  // namespace haptrial::evaluation
