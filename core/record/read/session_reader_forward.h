#pragma once

namespace haptrial::record {

// A forward declaration for headers that name a reader and do not use it.
class SessionReader;

}  // namespace haptrial::record
