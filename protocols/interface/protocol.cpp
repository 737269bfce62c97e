#include "protocols/interface/protocol.h"

#include <fmt/format.h>

#include "core/base/error.h"

namespace haptrial::protocols {

void Protocol::replay(const ReplayRequest& request) const {
  throw InputError(
      fmt::format("{}: sessions of {} cannot be replayed", request.file.string(), name()));
}

}  // namespace haptrial::protocols
