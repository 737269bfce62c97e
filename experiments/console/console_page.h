#pragma once

#include <string_view>

namespace haptrial::experiments {

/// console.html as it stands in the source; built in.
std::string_view console_page_template();

}  // namespace haptrial::experiments
