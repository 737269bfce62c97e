#include "core/bone/simulator/handpiece.h"

namespace haptrial::bone {

Shafts::Shafts(std::span<const ToolSpec> tools, std::span<const Structure> structures,
               double spacing, const std::array<bool, 256>& soft) {
  for (const ToolSpec& tool : tools) {
    const auto* burr = tool.as<BurrTool>();
    if (burr == nullptr || !burr->shaft) {
      parts_.push_back(nullptr);
      continue;
    }
    const ShaftParameters& shaft = *burr->shaft;
    const double middle = BurrShape(burr->burr.dimensions()).half_length() + 0.5 * shaft.length;
    parts_.push_back(std::make_unique<FeltPart>(shaft.dimensions(), middle, shaft.feel, structures,
                                                spacing, soft));
  }
}

Eigen::Vector3d Shafts::force(int tool, const BoneWorld& world, const ToolState& state) noexcept {
  FeltPart* part = parts_[static_cast<std::size_t>(tool)].get();
  return part != nullptr ? part->tick(world, state).force : Eigen::Vector3d::Zero();
}

void Shafts::wait() noexcept {
  for (const auto& part : parts_) {
    if (part != nullptr) {
      part->wait();
    }
  }
}

Handpiece::Handpiece(std::span<const ToolSpec> tools) {
  for (const ToolSpec& tool : tools) {
    const auto* burr = tool.as<BurrTool>();
    used_.push_back({burr != nullptr ? burr->burr : BurrParameters{}, 0.0});
  }
}

void Handpiece::take(int tool, double volume) noexcept {
  used_[static_cast<std::size_t>(tool)].removed += volume;
}

double Handpiece::sharpness(int tool) const noexcept {
  const UsedBurr& used = used_[static_cast<std::size_t>(tool)];
  return bone::sharpness(used.burr, used.removed);
}

}  // namespace haptrial::bone
