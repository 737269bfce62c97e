// Plug-ins for the tests of how they are refused; what each has is said where it is compiled.
#include "core/device/own_devices.h"
#include "core/scene/read/field_kinds.h"
#include "experiments/plugin/plugin.h"

#ifdef STAND_IN_OTHER_PROGRAM
#undef HAPTRIAL_PLUGIN_ABI
#define HAPTRIAL_PLUGIN_ABI "0.0.1, of another time"
#endif
#ifdef STAND_IN_UNLINKED
namespace haptrial::experiments {
void nobody_has_this();
}
#endif

namespace {

using haptrial::scene::FieldKind;
using haptrial::scene::FieldReader;

/// Nothing that can be felt.
class Calm final : public haptrial::scene::OwnLaw {
 public:
  Eigen::Vector3d force(const haptrial::scene::Felt&,
                        haptrial::scene::FieldState&) noexcept override {
    return Eigen::Vector3d::Zero();
  }
};

class CalmNumbers final : public haptrial::scene::OwnNumbers {
 public:
  std::unique_ptr<haptrial::scene::OwnLaw> law(const haptrial::scene::Setting&) const override {
    return std::make_unique<Calm>();
  }
};

[[maybe_unused]] FieldKind read_calm(const FieldReader&) {
  return haptrial::scene::OwnParameters{"calm", std::make_shared<CalmNumbers>()};
}

void add([[maybe_unused]] haptrial::experiments::PluginParts& parts) {
#if defined(STAND_IN_TAKEN_DEVICE)
  parts.device({"mouse", "of another maker", nullptr});
#elif defined(STAND_IN_TAKEN_FIELD)
  parts.field({"spring", read_calm});
#elif defined(STAND_IN_UNLINKED)
  haptrial::experiments::nobody_has_this();
#elif defined(STAND_IN_BAD_WORDS)
  parts.key_words("fields.NAME.calm: how calm it is");
#else
  parts.field({"calm", read_calm});
#endif
}

}  // namespace

#ifdef STAND_IN_BAD_NAME
HAPTRIAL_PLUGIN("two words", "1.0", add)
#else
HAPTRIAL_PLUGIN("stand-in", "1.0", add)
#endif
