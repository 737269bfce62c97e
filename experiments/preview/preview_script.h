#pragma once

#include <string_view>

namespace haptrial::experiments {

/// The scripts of a preview, in their element, as they stand in the source; built in. NONCE stands
/// for the nonce of a server that shows the page.
std::string_view preview_script();

}  // namespace haptrial::experiments
