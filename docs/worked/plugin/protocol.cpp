// The protocol of docs/worked/protocol as a plug-in.
#include "experiments/plugin/plugin.h"
#include "springs.h"

namespace {

void add(haptrial::experiments::PluginParts& parts) { parts.protocol(springs()); }

}  // namespace

HAPTRIAL_PLUGIN("springs", "1.0", add)
