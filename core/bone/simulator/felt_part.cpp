#include "core/bone/simulator/felt_part.h"

#include "core/bone/simulator/piece_contact.h"

namespace haptrial::bone {
namespace {

FeelParameters allowed(const FeelParameters& feel) {
  check(feel);
  return feel;
}

}  // namespace

FeltPart::FeltPart(const BurrDimensions& dimensions, double middle, const FeelParameters& feel,
                   std::span<const Structure> structures, double spacing,
                   const std::array<bool, 256>& soft)
    : middle_(middle),
      feel_(allowed(feel)),
      before_(feel_),
      at_rest_(for_bone(default_burr(BurrKind::kDiamond, dimensions), spacing)),
      drill_(at_rest_, structures, best_instruction_set(), soft) {}

FeltPart::Felt FeltPart::tick(const BoneWorld& world, const ToolState& tool,
                              const ForceTransition& transition) noexcept {
  ToolState part = tool;
  if (middle_ != 0.0) {
    part.tip.position += middle_ * tool.axis();
  }
  const Contact contact = touch_pieces(drill_, world, part);
  waits_until_free_ = waits_until_free_ && static_cast<bool>(contact);
  Felt felt;
  felt.immersed = contact.samples;
  if (contact && !waits_until_free_) {
    felt.force = bone_force(contact, feel_, at_rest_, 0.0);
    if (transition.is_on()) {
      const double w = transition.weight();
      felt.force = (1.0 - w) * bone_force(contact, before_, at_rest_, 0.0) + w * felt.force;
    }
  }
  return felt;
}

}  // namespace haptrial::bone
