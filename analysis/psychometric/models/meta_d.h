#pragma once

#include <cstddef>

#include "analysis/psychometric/models/rating.h"
#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

/// How well ratings of confidence tell right answers from wrong ones, in units of d'.
///
/// The observer of equal variances who would give these ratings, had they only the ratings'
/// evidence: noise N(-meta_d / 2, 1), signal N(meta_d / 2, 1), answer "signal" above
/// meta_d * criterion / d', criteria of the ratings on either side. Shares of ratings given
/// stimulus and answer are the likelihood's; the answers themselves give d' and criterion.
struct MetaD {
  double meta_d{0.0};
  double low{0.0}, high{0.0};              // 95 %, by Fisher's information
  double ratio{0.0};                       // M-ratio: meta_d / d'
  double ratio_low{0.0}, ratio_high{0.0};  // 95 %, by the delta method
  double d_prime{0.0}, criterion{0.0};     // of the answers, log-linear correction
  double log_likelihood{0.0};              // of the ratings
};

/// @param counts  ratings from the surest "noise" to the surest "signal".
/// @param noise_ratings  number of ratings that go with the answer "noise": the first ones.
/// Ratings that nobody gave are dropped. Undefined without signal or noise trials, with d' whose
/// 95 % interval reaches 0 (the ratio has no meaning there), with one rating only on both sides,
/// with a standard error of meta-d' of 1 or more, and if the likelihood has no maximum.
/// @throws std::invalid_argument as rating_roc, and for noise_ratings beyond the ratings.
/// Source: Maniscalco and Lau 2012, Consciousness and Cognition 21.
Defined<MetaD> meta_d_prime(const RatingCounts& counts, std::size_t noise_ratings);

}  // namespace haptrial::analysis
