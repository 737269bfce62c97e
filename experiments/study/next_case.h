#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace haptrial::experiments {

/// The case of a curriculum that comes next for a participant.
struct NextCase {
  std::string name;  // empty: every case is done
  std::string why;   // what was missed the last time, say; empty: it begins
};

/// Finds it from the participant's finished sessions, in their order; empty function: the study has
/// no curriculum. @throws InputError for a file that cannot be read
using FindCase = std::function<NextCase(const std::vector<std::filesystem::path>& sessions)>;

}  // namespace haptrial::experiments
