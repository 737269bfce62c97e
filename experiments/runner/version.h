#pragma once

namespace haptrial::experiments {

const char* program_version();  // "0.2.0"
const char* program_commit();   // short hash of the built commit; "unknown" outside a checkout

}  // namespace haptrial::experiments
