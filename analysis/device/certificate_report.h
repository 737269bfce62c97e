#pragma once

#include <filesystem>
#include <vector>

#include "analysis/device/certificate.h"
#include "analysis/document/finding.h"

namespace haptrial::analysis {

/// The measurements of one part of a handle, and the figures that follow from them.
struct PartCertificate {
  CertificateRecord record;
  CertificateResult result;
};

/// Everything that the record shows, beside it.
PartCertificate identify_part(CertificateRecord record, const Excitation& excitation);

/// Findings of a certificate: `summary` with the figures that definitions use, then `static_force`,
/// `frequency_response`, `motion`, `free_motion` and `walls` where they were measured; the same of
/// a rotation as `rotation_summary` and so on, about its axes, and of a grip as `grip_summary`. A
/// figure that the record does not tell, or a part without motors, has a reason instead.
/// @param parts  the tip first; a rotation and a grip if they were measured
std::vector<FindingList> certificate_findings(const std::vector<PartCertificate>& parts);

/// The findings as JSON, with the device, whether it is simulated and the version of the format.
std::string certificate_json(const std::vector<PartCertificate>& parts,
                             const std::vector<FindingList>& findings);

/// Writes certificate.html, certificate.json and the pictures into a folder, which is made if it is
/// not there. @throws InputError if the folder cannot be written, RunError if a picture fails
void write_certificate(const std::vector<PartCertificate>& parts,
                       const std::filesystem::path& folder);

}  // namespace haptrial::analysis
