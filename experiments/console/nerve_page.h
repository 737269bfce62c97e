#pragma once

#include <string>
#include <string_view>

#include "core/nerve/beside/monitor_desk.h"

namespace haptrial::experiments {

/// nerves.html as it stands in the source; built in.
std::string_view nerve_page_template();

/// What came on a nerve monitor since the last call, as one line of JSON; samples in multiples of
/// 0.1 uV.
std::string nerve_json(const nerve::MonitorDesk::View& view);

/// {"channel": 0, "muted": true} or {"channel": 0, "threshold": 150e-6}, 10 to 400 uV.
/// @throws InputError
nerve::MonitorOrder parse_nerve_order(const std::string& json);

}  // namespace haptrial::experiments
