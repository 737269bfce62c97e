#pragma once

#include <optional>
#include <string>

#include "core/base/definition/schema_forward.h"

namespace haptrial::device {

/// The number of the form in which `certificate.json` is written and read.
inline constexpr int kCertificateFormat = 1;

/// The figures of one part of a handle by a certificate: in N for tip and grip, in N·m for a
/// rotation.
struct CertifiedForce {
  std::optional<double> gain, gain_low, gain_high;  // force measured per force commanded, 95 %
  std::optional<double> dead_zone;                  // a shorter command gives no force >= 0
  std::optional<double> friction;                   // >= 0
  std::optional<double> force_noise;                // root mean square of force ripple >= 0
  std::optional<double> delay;                      // from a command to its force >= 0 [s]
  std::optional<double> stiffest_wall;              // that stays passive > 0 [N/m], [N·m/rad]
};

/// Key figures of a device's certificate (haptrial device-test --certificate), as definitions, lab
/// files and session files hold them. A figure that the certificate does not have is left out. Its
/// own figures are those of the tip.
struct Certificate : CertifiedForce {
  std::string file;       // name of the certificate, without folders
  std::string checksum;   // FNV-1a of its bytes, 16 hexadecimal digits
  std::string device;     // name of the device
  bool simulated{false};  // the device was a virtual one
  std::optional<CertifiedForce> rotation, grip;
};

/// The certificate that a definition's text states; nothing if it states none, or no longer reads.
/// @param name  of the definition, for sentences
std::optional<Certificate> certificate_in(const std::string& definition, const std::string& name);

/// The keys of [certificate].
const Schema<Certificate>& certificate_schema();

}  // namespace haptrial::device
