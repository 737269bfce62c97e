#include "protocols/bone_drilling/definition/smallest_burr.h"

#include <algorithm>

#include "protocols/bone_drilling/definition/bone_definition.h"

namespace haptrial::protocols {

double smallest_burr(const BoneDefinition& d) {
  double radius = 1.0;
  for (const bone::ToolSpec& tool : d.simulator.tools) {
    const auto* burr = tool.as<bone::BurrTool>();
    radius = burr != nullptr ? std::min(radius, burr->radius()) : radius;
  }
  return radius;
}

}  // namespace haptrial::protocols
