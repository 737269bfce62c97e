#include "experiments/study/launch_rank.h"

#include <charconv>
#include <cstdlib>
#include <string_view>
#include <utility>

namespace haptrial::experiments {
namespace {

std::optional<int> number_of(const char* text) {
  if (text == nullptr) {
    return std::nullopt;
  }
  const std::string_view digits(text);
  int number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return error == std::errc() && end == digits.data() + digits.size() ? std::optional(number)
                                                                      : std::nullopt;
}

}  // namespace

std::optional<LaunchRank> launch_rank(const std::function<const char*(const char*)>& variable) {
  // srun's come last: mpirun within a batch job inherits those of the job.
  for (const auto& [rank_name, size_name] :
       {std::pair{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
        std::pair{"PMI_RANK", "PMI_SIZE"}, std::pair{"SLURM_PROCID", "SLURM_STEP_NUM_TASKS"}}) {
    const std::optional<int> rank = number_of(variable(rank_name));
    const std::optional<int> size = number_of(variable(size_name));
    if (rank && size && *size > 1 && *rank >= 0 && *rank < *size) {
      return LaunchRank{*rank, *size};
    }
  }
  return std::nullopt;
}

std::optional<LaunchRank> launch_rank() {
  return launch_rank([](const char* name) -> const char* { return std::getenv(name); });
}

}  // namespace haptrial::experiments
