#include "core/contact/renderer.h"

#include <stdexcept>
#include <string>

namespace haptrial::contact {

std::string_view name_of(RendererKind kind) {
  switch (kind) {
    case RendererKind::kProxy:
      return "proxy";
    case RendererKind::kRuspini:
      return "ruspini";
    case RendererKind::kPenalty:
      return "penalty";
    case RendererKind::kVoxel:
      return "voxel";
    case RendererKind::kDistanceField:
      return "distance field";
  }
  return "";
}

RendererKind renderer_kind(std::string_view name) {
  std::string allowed;
  for (const RendererKind kind : kRendererKinds) {
    if (name == name_of(kind)) {
      return kind;
    }
    allowed += (allowed.empty() ? "\"" : ", \"") + std::string(name_of(kind)) + "\"";
  }
  throw std::invalid_argument("renderer \"" + std::string(name) + "\": allowed: " + allowed);
}

}  // namespace haptrial::contact
