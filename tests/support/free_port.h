#pragma once

#include <cstdint>

namespace haptrial::test {

/// A port of this machine that nobody uses at the moment, for connections and for datagrams. The
/// system gives no such port to anybody who does not ask for it, and tests that run beside each
/// other are given different ones.
std::uint16_t free_port();

}  // namespace haptrial::test
