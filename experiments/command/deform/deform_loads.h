#pragma once

#include <string>
#include <vector>

#include "experiments/command/deform/deform_body.h"

namespace haptrial::experiments {

/// All loads of the file, or those named. A recorded session gives one load for each touch.
/// @throws InputError for a name that the file has not, and as load_case_of() and check_load().
std::vector<NamedLoad> loads_of(const DeformBody& body, const std::vector<std::string>& names = {});

}  // namespace haptrial::experiments
