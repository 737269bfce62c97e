#pragma once

#include <string>
#include <vector>

#include "analysis/bone_drilling/report/validity_findings.h"

namespace haptrial::analysis::drilling {

/// Results in words, the same in the command's lines, in captions and in the report (wording.h has
/// those of all studies).

std::string undefined(const std::string& because);
/// The mean of participants' means: "3.438 [3.182, 3.693]", "3.438" if it has no interval, or "–".
std::string mean_word(const GroupValues& group);
/// "p = 0.0123" or "–".
std::string word(const Defined<double>& p);
/// "0.63, p = 0.011" or "–".
std::string correlation_word(const Defined<Correlation>& c);
/// "0.63 (p = 0.18 after Holm's adjustment over 21 metrics)" or "–": R over participants' means.
std::string relation_word(const Validity& v, const MetricValidity& metric);
/// "0.88 [0.73, 1.00]" or "–".
std::string area_word(const Defined<Roc>& roc);
/// "0.81, 95 % CI 0.62 to 0.92, F(11, 22) = 13.6, p < 0.001".
/// @param apart  procedures are of different participants: else there is no interval and no p.
std::string form_word(const Defined<IntraclassForm>& form, bool apart);
/// "difference 1.080, 95 % CI 0.5949 to 1.566, t(13.0) = 4.81, p < 0.001".
std::string welch_word(const Contrast& c);
std::string mixed_word(const Contrast& c);
/// "59 % lower than that of the other participants' mean rating".
std::string error_word(const CrossValidated& fit);
/// "force near vital structures (N)".
std::string name_of(const MetricKind& kind);

/// A sentence if raters scored different procedures: "Not every rater scored all of the 30 rated
/// procedures (li 30, smith 14), so …"; else empty.
std::string uneven_raters(const Validity& v);

/// Every group once: a side that is one group is not listed again.
std::vector<const GroupValues*> shown_groups(const Validity& v);
/// Among how many metrics Holm's method adjusts.
std::size_t contrasts_of(const Validity& v);
std::size_t relations_of(const Validity& v);

}  // namespace haptrial::analysis::drilling
