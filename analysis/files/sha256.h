#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace haptrial::analysis {

/// SHA-256 of some bytes in 64 hexadecimal digits, as sha256sum prints it.
std::string sha256_of(std::string_view bytes);
/// SHA-256 of a file's bytes, likewise. @throws InputError naming a file that cannot be read
std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace haptrial::analysis
