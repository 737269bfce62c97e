#pragma once

#include <cstdint>

#include "analysis/device/certificate_record.h"
#include "core/device/sensed_mount.h"
#include "core/device/virtual_device.h"

namespace haptrial::test {

/// The measurement of a certificate on a virtual device, without a loop or an envelope.
/// @param parts  those that are recorded; the others stay empty
/// @param reach  of the moved handle to either side [m]
analysis::CertificateRecord simulated_certificate(
    const device::VirtualDeviceParameters& electronics, const device::SensedMountParameters& mount,
    const analysis::Excitation& excitation, std::uint64_t seed,
    const std::vector<analysis::CertificatePart>& parts, double reach = 0.04);

}  // namespace haptrial::test
