#pragma once

#include "analysis/statistics/design/analysis_plan.h"
#include "analysis/statistics/design/design_effects.h"
#include "analysis/statistics/design/design_sides.h"

namespace haptrial::analysis {

/// The difference of two sides at the mean of a covariate, by ordinary least squares:
///
///     paired        a - b = difference + slope (x - mean x)
///     different     value = side + slope x, one slope and one variance for both sides
///
/// Participants without a value of the covariate take no part. Undefined where other groups lie
/// across both sides, and as linear_regression().
Defined<TTest> adjusted_test(const DesignTable& table, const Sides& sides,
                             const Covariate& covariate, Tail tail);

/// The analysis of covariance of one factor: between participants, whether the levels differ at one
/// value of the covariate, with one slope; within, whether they differ at its mean, with a slope of
/// each level and without a correction for sphericity.
/// Undefined for several factors.
Defined<EffectTest> adjusted_effect(const DesignTable& table, const Covariate& covariate);

}  // namespace haptrial::analysis
