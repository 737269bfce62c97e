#pragma once

namespace haptrial::record {

/// For headers that name a reader and do not use it.
class SessionReader;

}  // namespace haptrial::record
