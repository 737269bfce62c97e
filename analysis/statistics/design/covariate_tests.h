#pragma once

#include "analysis/statistics/design/analysis_plan.h"
#include "analysis/statistics/design/design_effects.h"
#include "analysis/statistics/design/design_sides.h"

namespace haptrial::analysis {

/// The difference of two sides of different people at one value of a covariate, by ordinary least
/// squares with one variance for both sides:
///
///     value = side + slope x
///
/// Participants without a value of the covariate take no part. Undefined for the same people, whose
/// test at the mean covariate takes the covariates as given and rejects a mean difference of 0 over
/// people too often (docs/algorithms/statistics.md); where other groups lie across both sides; and
/// as linear_regression().
Defined<TTest> adjusted_test(const DesignTable& table, const Sides& sides,
                             const Covariate& covariate, Tail tail);

/// The analysis of covariance of one factor: between participants, whether the levels differ at one
/// value of the covariate, with one slope; within, whether their differences follow the covariate
/// ("factor × covariate"), in the stratum of participants x levels and without a correction for
/// sphericity.
/// Undefined for several factors.
Defined<EffectTest> adjusted_effect(const DesignTable& table, const Covariate& covariate);

}  // namespace haptrial::analysis
