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

/// Figures of the part of the handle that levels of a unit act on: torques on the rotation, forces
/// on the grip if the definition's fields and objects act on nothing else, on the tip if they do
/// not act on the grip. Nothing if they act on both, or if the part has no gain.
std::optional<device::CertifiedForce> figures_of(const std::string& unit,
                                                 const device::Certificate& certificate,
                                                 const std::string& definition);

/// A level as commanded and its interval, as the part gives it: the gain times what a force has
/// beyond the dead zone; stiffnesses and the like are taken for large forces, times the gain. Both
/// intervals widen the product's. @param figures  with a gain
Estimated as_measured(const Estimated& commanded, const std::string& unit,
                      const device::CertifiedForce& figures);

/// The levels as commanded and as measured; no table if no gain is stated. The certificate itself
/// is a finding of every protocol (analysis/exchange/own_findings.cpp).
FindingList apparatus_findings(const TrialsResult& result);

}  // namespace haptrial::analysis::trials
