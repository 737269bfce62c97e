#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace haptrial::test {

/// The folder of data from outside that the project does not ship: the one that the environment
/// variable HAPTRIAL_DATA names, else `shared/data` beside the checkout. Nothing where neither is
/// there.
inline std::optional<std::filesystem::path> shared_data_folder(
    const std::filesystem::path& checkout) {
  const char* named = std::getenv("HAPTRIAL_DATA");
  const std::filesystem::path folder = named != nullptr && *named != '\0'
                                           ? std::filesystem::path(named)
                                           : checkout.parent_path() / "shared" / "data";
  return std::filesystem::is_directory(folder) ? std::optional(folder) : std::nullopt;
}

/// A file below that folder; tests skip, saying so, where it is absent.
inline std::optional<std::filesystem::path> shared_data(const std::string& name) {
  const auto folder = shared_data_folder(HAPTRIAL_SOURCE_DIR);
  return folder && std::filesystem::exists(*folder / name) ? std::optional(*folder / name)
                                                           : std::nullopt;
}

}  // namespace haptrial::test
