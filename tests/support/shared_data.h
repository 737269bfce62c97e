#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace haptrial::test {

/// A file below the folder that the environment variable HAPTRIAL_DATA names: data from outside
/// that the project does not ship. Nothing where it is absent; tests then skip, saying so.
inline std::optional<std::filesystem::path> shared_data(const std::string& name) {
  const char* folder = std::getenv("HAPTRIAL_DATA");
  if (folder == nullptr || *folder == '\0') {
    return std::nullopt;
  }
  const std::filesystem::path file = std::filesystem::path(folder) / name;
  return std::filesystem::exists(file) ? std::optional(file) : std::nullopt;
}

}  // namespace haptrial::test
