#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "analysis/psychometric/fit/credible.h"
#include "analysis/psychometric/fit/fitted_function.h"
#include "analysis/statistics/base/defined.h"
#include "core/psychometric/procedure/procedure.h"

namespace haptrial::analysis {

/// A track that is over, and how to begin it anew.
struct FinishedTrack {
  psychometric::Estimate estimate;  // the procedure's own [level]
  std::size_t trials{0};
  bool finished{true};  // else it was broken off after `trials`
  std::function<std::unique_ptr<psychometric::Procedure>()> begin;
};

/// The 95 % interval of the level that the procedure seeks (Procedure::target), around the
/// procedure's own estimate: observers with the functions that the answers leave open do the track
/// anew, and the interval is the estimate less the central 95 % of their errors. So it knows of the
/// procedure's bias, of the dependence of its levels, and of what the answers do not tell about the
/// width. If the estimate has a deviation, an error counts by the track's scatter: in units of
/// sqrt(deviation^2 + variance of all the errors).
/// @param shape  of the functions, with their axis
/// @param draws  of adaptive_posterior(), some hundred
/// @param seed   of the observers' answers
/// @returns levels; not defined if the procedure seeks no level of a probability, or if too few of
/// the tracks give an estimate
Defined<CredibleInterval> track_interval(const FinishedTrack& track,
                                         const psychometric::PsychometricParameters& shape,
                                         std::span<const FittedParameters> draws,
                                         std::uint64_t seed);

}  // namespace haptrial::analysis
