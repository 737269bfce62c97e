#pragma once

#include <cstddef>
#include <functional>

namespace haptrial::geometry {

/// As many threads as the machine has processors where `threads` is 0 or less.
int threads_or_all(int threads);

/// Calls work(0) .. work(count - 1), each once, on `threads` threads, this one among them; they
/// take the next item as they become free. The first exception ends the work and is thrown here.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& work);

}  // namespace haptrial::geometry
