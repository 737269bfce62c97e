#include "protocols/interface/protocol.h"

#include <fmt/format.h>

#include "core/base/error.h"

namespace haptrial::protocols {

std::unique_ptr<Definition> Protocol::of_case(const Definition& definition,
                                              const std::string& name) const {
  throw InputError(
      fmt::format("{}: has no case '{}': it has no curriculum", definition.file_name, name));
}

void Protocol::replay(const ReplayRequest& request) const {
  throw InputError(
      fmt::format("{}: sessions of {} cannot be replayed", request.file.string(), name()));
}

}  // namespace haptrial::protocols
