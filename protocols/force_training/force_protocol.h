#pragma once

#include "protocols/interface/protocol.h"

namespace haptrial::protocols {

/// protocol = "force_training"
const Protocol& force_training();

}  // namespace haptrial::protocols
