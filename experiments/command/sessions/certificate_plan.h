#pragma once

#include <vector>

#include "analysis/device/excitation.h"
#include "experiments/command/sessions/device_bench.h"
#include "protocols/definition/device_arm.h"

namespace haptrial::experiments {

/// How far a part is moved to either side at the fingers [m].
double reach_of(device::Part part, double radius, double workspace_radius);

/// The commands for a part. @param most  force that the device gives there [N]
analysis::Excitation excitation_of(const protocols::DeviceArm& arm,
                                   const analysis::DrivenAxes& axes, double most,
                                   double workspace_radius);

/// The known load of a part; 0: none [kg].
double load_of(const DeviceTestOptions& options, const protocols::DeviceArm& arm);

/// The parts of a measurement without a sensor. A rotation or grip is not let go to be moved: its
/// ways are too short to identify anything from.
std::vector<analysis::CertificatePart> parts_without_sensor(const DeviceTestOptions& options,
                                                            const protocols::DeviceArm& arm);

}  // namespace haptrial::experiments
