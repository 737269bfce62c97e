#pragma once

#include <filesystem>
#include <string>

namespace haptrial {

/// All bytes of a file. @throws InputError where it cannot be read.
std::string file_text(const std::filesystem::path& file);

}  // namespace haptrial
