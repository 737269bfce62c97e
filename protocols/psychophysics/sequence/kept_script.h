#pragma once

namespace haptrial::record {
class SessionReader;
}

namespace haptrial::protocols {

struct ScriptPlan;

/// Whether an earlier run of the session kept the script's text.
/// @param event  the kind of event that holds it
/// @throws InputError where its script was another one
bool kept_before(const ScriptPlan& plan, const char* event, const record::SessionReader& earlier);

}  // namespace haptrial::protocols
