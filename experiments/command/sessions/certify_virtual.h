#pragma once

#include <vector>

#include "analysis/device/certificate_report.h"
#include "experiments/command/sessions/device_bench.h"

namespace haptrial::experiments {

/// Certificates of the virtual tip, and of the rotation and grip that the definition gives it.
/// @throws RunError if the simulated device has a fault
std::vector<analysis::PartCertificate> virtual_certificates(const DeviceTestOptions& options,
                                                            const DeviceSetup& setup);

}  // namespace haptrial::experiments
