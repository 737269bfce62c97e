#pragma once

#include <string>
#include <vector>

#include "analysis/document/number.h"
#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/design/design_tests.h"
#include "analysis/statistics/tests/shapiro_wilk.h"
#include "analysis/statistics/tests/t_tests.h"
#include "analysis/statistics/variance/anova.h"
#include "analysis/statistics/variance/effect_size.h"
#include "analysis/statistics/variance/rank_anova.h"
#include "analysis/statistics/variance/repeated_anova.h"

namespace haptrial::analysis {

/// Results in words, the same in the command's summary and in the report. What is not defined
/// becomes "not defined, because ...".

/// "p = 0.012", "p < 0.001"; more digits if two would round to the level of 0.05: "p = 0.0499".
std::string p_value(double p);
/// "1.234, 95 % CI 1.1 to 1.3".
std::string mean_with_interval(const Defined<MeanInterval>& interval);
/// The mean alone where it has no interval.
std::string mean_with_interval(const Mean& mean);
/// "F(2, 861) = 12.3, p < 0.001, η² = 0.028".
std::string anova_result(const Defined<Anova>& anova);
/// "F(2, 22) = 12.3, p < 0.001; Greenhouse–Geisser ε = 0.87, p < 0.001; partial η² = 0.4".
std::string anova_result(const Defined<RepeatedAnova>& anova);
/// "t(574) = -2.91, p = 0.002".
std::string t_result(const Defined<TTest>& test);
/// "χ²(2) = 9.1, p = 0.011", " (approximate)" behind a p value that is not exact.
std::string rank_result(const Defined<RankAnova>& test);
/// Holm's p of the test on ranks of two sides: "p = 0.034", likewise.
std::string ranks_p(const SideTest& test);
/// "F(2, 22) = 12.3, p = 0.013 (repeated-measures analysis of variance, Greenhouse–Geisser ε =
/// 0.64), partial η² = 0.40".
std::string effect_result(const EffectTest& effect);
/// A sentence for a methods section on how conditions were compared: "Conditions were compared by
/// repeated-measures analysis of variance with Greenhouse and Geisser's correction, …".
std::string comparison_words(const DesignTests& tests);
/// Sentences for the same section on the tests beside the planned ones, the covariate and the rule
/// by which a study may end early. @param of  the tested quantity, "mean reaction time"
std::vector<std::string> sentences_beside(const DesignTests& tests, const std::string& of);
/// "difference -0.19, 95 % CI -0.50 to 0.11 (two-sided, not adjusted), paired t(11) = -1.39,
/// p = 0.096 after Holm's adjustment, one-tailed".
std::string side_result(const SideTest& test);
/// "-0.51 to 0.11", or that there are too few participants.
std::string bootstrap_result(const SideTest& test);
/// "p = 0.0123", or why there is none.
std::string p_result(const Defined<double>& p);
/// "-0.42, 95 % CI -0.71 to -0.13".
std::string effect(const Defined<EffectSize>& size);
/// "F(2, 861) = 2.1, p = 0.12".
std::string levene_result(const Defined<Anova>& test);
/// "W = 0.97, p = 0.03".
std::string normality_result(const Defined<ShapiroWilk>& test);
/// A sentence on Mauchly's test and Huynh and Feldt's correction.
std::string sphericity_result(const Defined<RepeatedAnova>& anova);
/// The value times `factor` with its unit, or why there is none.
std::string quantity(const Defined<double>& value, double factor, const std::string& unit);
/// "Visuohaptic" of "visuohaptic".
std::string capitalized(std::string text);
/// "1 trial", "2 passes".
std::string counted(std::size_t count, const std::string& noun);

/// "3.438 [3.182, 3.693]" or "–", for tables.
std::string interval_word(const Defined<MeanInterval>& interval);
/// The mean alone where it has no interval.
std::string interval_word(const Mean& mean);

}  // namespace haptrial::analysis
