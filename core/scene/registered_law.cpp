#include "core/scene/registered_law.h"

#include "core/base/require.h"

namespace haptrial::scene {

/// Nothing lies on such a field, and it lies on nothing.
FieldTraits RegisteredParameters::traits() const {
  FieldTraits traits = numbers->traits();
  traits.surface = traits.relief = traits.object = false;
  return traits;
}

RegisteredField::RegisteredField(const RegisteredParameters& parameters, const Setting& setting)
    : type_(parameters.type) {
  require(parameters.numbers != nullptr, "has no numbers");
  law_ = parameters.numbers->law(setting);
  require(law_ != nullptr, "has no law");
}

Eigen::Vector3d RegisteredField::force(const Felt& felt, FieldState& state) noexcept {
  const Eigen::Vector3d force = law_->force(felt, state);
  return force.allFinite() ? Eigen::Vector3d(felt.shares.stiffness * force)
                           : Eigen::Vector3d::Zero();
}

void RegisteredField::adopt(const RegisteredField& before) noexcept {
  if (type_ == before.type_) {
    law_->adopt(*before.law_);
  }
}

}  // namespace haptrial::scene
