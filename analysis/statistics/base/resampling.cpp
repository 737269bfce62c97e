#include "analysis/statistics/base/resampling.h"
#include "core/base/parallel.h"

namespace haptrial::analysis {

void for_each_part(
    const Resampling& resampling,
    const std::function<void(RandomStream& random, std::size_t first, std::size_t last)>& draw) {
  constexpr std::size_t kPart = 256;  // draws
  in_groups(resampling.count, kPart, resampling.threads, [&] {
    return [&](std::size_t first, std::size_t count) {
      RandomStream random(resampling.seed, resampling.stream + "/" + std::to_string(first / kPart));
      draw(random, first, first + count);
    };
  });
}

}  // namespace haptrial::analysis
