#pragma once

namespace haptrial::experiments {

const char* program_version();  // "0.1.0"
const char* program_commit();   // short hash of the built commit; "unknown" outside a checkout

}  // namespace haptrial::experiments
