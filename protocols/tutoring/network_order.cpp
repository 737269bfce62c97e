#include "protocols/tutoring/network_order.h"

#include <fmt/format.h>

#include <numeric>
#include <utility>
#include <vector>

#include "core/base/random.h"

namespace haptrial::protocols {

std::size_t network_of_trial(std::size_t trial, std::size_t count, std::uint64_t seed) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  RandomStream random(seed, fmt::format("networks {}", trial / count));
  for (std::size_t i = count - 1; i > 0; --i) {
    std::swap(order[i], order[static_cast<std::size_t>(random.below(i + 1))]);
  }
  return order[trial % count];
}

}  // namespace haptrial::protocols
