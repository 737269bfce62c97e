#pragma once

#include <string>
#include <vector>

#include "protocols/definition/definition.h"

namespace haptrial::protocols {

/// Sentences on a coupling over a link that may swing up, or cannot act.
std::vector<std::string> tutoring_warnings(const Definition& definition);

}  // namespace haptrial::protocols
