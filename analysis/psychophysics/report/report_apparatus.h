#pragma once

#include <optional>

#include "analysis/document/finding.h"
#include "analysis/psychophysics/study/trials_result.h"
#include "core/device/certificate.h"

namespace haptrial::analysis::trials {

/// The certificate that the sessions' definition states; nothing if it states none.
std::optional<device::Certificate> certificate_of(const TrialsResult& result);

/// Whether a level with this unit is as many times as large on the hand as a force is: "N", "N/m".
bool grows_with_force(const std::string& unit);

/// A level as commanded and its interval, times the gain; both intervals widen the product's.
/// @param certificate  with a gain
Estimated as_measured(const Estimated& commanded, const device::Certificate& certificate);

/// The levels as commanded and as measured; no table if no gain is stated. The certificate itself
/// is a finding of every protocol (analysis/exchange/own_findings.cpp).
FindingList apparatus_findings(const TrialsResult& result);

}  // namespace haptrial::analysis::trials
