#pragma once

#include <string>

#include "analysis/device/certificate.h"
#include "analysis/document/finding.h"

namespace haptrial::analysis {

Finding finding(const char* name, const std::string& title, const Interval& interval,
                const char* unit);
/// @param why  completes "not defined, because"
Finding missing(const char* name, const std::string& title, const char* unit, std::string why);

/// The figures that definitions use, over all axes: what a certificate says in short.
FindingList certificate_summary(const CertificateRecord& record, const CertificateResult& result);

}  // namespace haptrial::analysis
