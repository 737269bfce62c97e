#include "core/scene/field.h"

namespace haptrial::scene {

const std::string& surface_of(const Field& field) noexcept {
  static const std::string kNone;
  return std::visit(
      [](const auto& p) -> const std::string& {
        if constexpr (requires { p.on; }) {
          return p.on;
        } else {
          return kNone;
        }
      },
      field.kind);
}

}  // namespace haptrial::scene
