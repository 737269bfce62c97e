#pragma once

#include <cmath>

#include "core/scene/read/field_kinds.h"

/// A kind of field: a valley along x, whose walls grow with the cube of the distance.
namespace own {

using namespace haptrial::scene;

struct ValleyParameters {
  double strength{1.0};  // s >= 0 [N]
  double width{0.01};    // w > 0 [m]
};

inline const haptrial::Schema<ValleyParameters>& valley_schema() {
  using P = ValleyParameters;
  static const auto schema = haptrial::Schema<P>()
                                 .number("strength", &P::strength, kStrengthBounds, "N",
                                         "Force of a valley at the distance width from its middle")
                                 .required()
                                 .number("width", &P::width, kLengthBounds, "m",
                                         "Distance at which a valley has its strength")
                                 .required();
  return schema;
}

/// f_z = -s (z / w)^3 [N]
class Valley final : public RegisteredLaw {
 public:
  explicit Valley(const ValleyParameters& parameters) : p_(parameters) {}
  Eigen::Vector3d force(const Felt& felt, FieldState& state) noexcept override {
    const double share = felt.hand.position.z() / p_.width;
    state.depth = std::abs(felt.hand.position.z());
    return {0.0, 0.0, -p_.strength * share * share * share};
  }

 private:
  ValleyParameters p_;
};

class ValleyNumbers final : public RegisteredNumbers {
 public:
  explicit ValleyNumbers(const ValleyParameters& parameters) : parameters_(parameters) {}
  std::unique_ptr<RegisteredLaw> law(const Setting&) const override {
    return std::make_unique<Valley>(parameters_);
  }

 private:
  ValleyParameters parameters_;
};

/// [fields.NAME] type = "valley": strength [N] at the distance width [m]. Formulas may stand there.
inline FieldKind read_valley(haptrial::Table& table, const FieldSetting&) {
  const ValleyParameters p = valley_schema().read(table);
  return RegisteredParameters{"valley", std::make_shared<ValleyNumbers>(p)};
}

inline void add_valley() { add_kind_of_field({"valley", read_valley}); }

}  // namespace own
