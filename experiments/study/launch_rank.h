#pragma once

#include <functional>
#include <optional>

namespace haptrial::experiments {

/// Which of several like processes this one is.
struct LaunchRank {
  int rank{0};
  int size{1};
};

/// Rank that mpirun (OpenMPI, MPICH) or srun told this process by its environment; nothing: it was
/// started alone. @param variable  value of an environment variable, or null
std::optional<LaunchRank> launch_rank(const std::function<const char*(const char*)>& variable);
std::optional<LaunchRank> launch_rank();

}  // namespace haptrial::experiments
