#pragma once

#include <string_view>

namespace haptrial::experiments {

/// The studio's page with its styles and scripts as they stand in the source; built in.
std::string_view studio_page_template();

}  // namespace haptrial::experiments
