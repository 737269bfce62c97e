#pragma once

#include "protocols/interface/protocol.h"

namespace haptrial::protocols {

/// Experiments that a definition states whole: perception, magnitudes, movements.
const Protocol& trials_protocol();

}  // namespace haptrial::protocols
