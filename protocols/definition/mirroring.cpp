#include "protocols/definition/mirroring.h"

#include <fmt/format.h>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "protocols/definition/definition.h"

namespace haptrial::protocols {

void read_mirroring(Table& design, Definition& definition) {
  constexpr const char* kKey = "mirror_left_handed";
  design.describe({kKey, "Whether left-handed participants feel and see the mirror image", "false",
                   false});
  definition.mirror_left_handed = design.has(kKey) && design.boolean(kKey);
  if (definition.mirror_left_handed && tips_of(definition.arms()) > 1) {
    design.reject(kKey,
                  "is true, but the definition drives several devices, whose hands would have to "
                  "change places; leave it out and give the devices to the other hands");
  }
}

void mirror_for(const std::string& handedness, Definition& definition) {
  if (!definition.mirror_left_handed) {
    return;
  }
  if (handedness != "left" && handedness != "right") {
    throw InputError(fmt::format(
        "--handedness is '{}'; the definition has design.mirror_left_handed, so it must be 'left' "
        "or 'right'",
        handedness));
  }
  definition.display.mirrored = handedness == "left";
}

}  // namespace haptrial::protocols
