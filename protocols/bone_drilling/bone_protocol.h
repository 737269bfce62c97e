#pragma once

#include "protocols/interface/protocol.h"

namespace haptrial::protocols {

/// protocol = "bone_drilling"
const Protocol& bone_drilling();

}  // namespace haptrial::protocols
