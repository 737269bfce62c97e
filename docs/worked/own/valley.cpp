// haptrial with one kind of field more: a valley along x, whose walls grow with the cube of the
// distance.
#include <algorithm>
#include <cmath>

#include "core/scene/read/field_kinds.h"
#include "experiments/command/keys/key_list.h"
#include "experiments/command/line/whole_command.h"

namespace {

using namespace haptrial::scene;

/// f_z = -s (z / w)^3 [N]
class Valley final : public RegisteredLaw {
 public:
  Valley(double strength, double width) : strength_(strength), width_(width) {}
  Eigen::Vector3d force(const Felt& felt, FieldState& state) noexcept override {
    const double share = felt.hand.position.z() / width_;
    state.depth = std::abs(felt.hand.position.z());
    return {0.0, 0.0, -strength_ * share * share * share};
  }

 private:
  double strength_;  // [N]
  double width_;     // [m]
};

class ValleyNumbers final : public RegisteredNumbers {
 public:
  ValleyNumbers(double strength, double width) : strength_(strength), width_(width) {}
  std::unique_ptr<RegisteredLaw> law(const Setting&) const override {
    return std::make_unique<Valley>(strength_, width_);
  }

 private:
  double strength_;
  double width_;
};

/// [fields.NAME] type = "valley": strength [N] at the distance width [m]. Formulas may stand there.
FieldKind read_valley(const FieldReader& read) {
  const double strength = read.number("strength", kStrengthBounds, "N");
  const double width = std::max(read.number("width", kLengthBounds, "m"), 1e-6);
  return RegisteredParameters{"valley", std::make_shared<ValleyNumbers>(strength, width)};
}

}  // namespace

int main(int argc, char** argv) {
  using namespace haptrial::experiments;
  return whole_command(argc, argv, [] {
    add_kind_of_field({"valley", read_valley});
    add_key_words(
        "fields.NAME.strength | | force of a valley at the distance width from its middle\n"
        "fields.NAME.width | | distance at which a valley has its strength");
  });
}
