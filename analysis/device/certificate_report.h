#pragma once

#include <filesystem>
#include <vector>

#include "analysis/device/certificate.h"
#include "analysis/document/finding.h"

namespace haptrial::analysis {

/// Findings of a certificate: `summary` with the figures that definitions use, then `static_force`,
/// `frequency_response`, `motion`, `free_motion` and `walls` where they were measured. A figure
/// that the record does not tell has a reason instead.
std::vector<FindingList> certificate_findings(const CertificateRecord& record,
                                              const CertificateResult& result);

/// The findings as JSON, with the device, whether it is simulated and the version of the format.
std::string certificate_json(const CertificateRecord& record,
                             const std::vector<FindingList>& findings);

/// Writes certificate.html, certificate.json and the pictures into a folder, which is made if it is
/// not there. @throws InputError if the folder cannot be written, RunError if a picture fails
void write_certificate(const CertificateRecord& record, const CertificateResult& result,
                       const std::filesystem::path& folder);

}  // namespace haptrial::analysis
