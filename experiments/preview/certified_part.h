#pragma once

#include <string>
#include <vector>

#include "experiments/preview/preview_page.h"
#include "protocols/definition/definition.h"

namespace haptrial::experiments {

/// A demand of an experiment on the device.
struct DeviceDemand {
  std::string name;       // of a field, a spring, a burr
  double stiffness{0.0};  // infinite: the force jumps [N/m]
  double damping{0.0};    // [N·s/m]
};

/// Compares demands with the certificate that the definition names (device.certificate); a sentence
/// if it names none.
void add_certified(const protocols::Definition& definition,
                   const std::vector<DeviceDemand>& demands, Preview& preview);

}  // namespace haptrial::experiments
