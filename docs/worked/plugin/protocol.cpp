// The protocol of docs/worked/protocol as a plug-in.
#include "experiments/plugin/plugin.h"
#include "springs.h"

namespace {

void add(haptrial::experiments::PluginParts& parts) {
  parts.protocol(springs());
  parts.key_words(
      "springs.standard | | stiffness of the spring that others are compared with\n"
      "springs.difference | | by how much the other spring is stiffer in the first trial\n"
      "springs.factor | | the difference is divided or multiplied by it\n"
      "springs.interval | | how long each spring is felt");
}

}  // namespace

HAPTRIAL_PLUGIN("springs", "1.0", add)
