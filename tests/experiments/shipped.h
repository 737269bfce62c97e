#pragma once

#include <filesystem>
#include <string>

namespace haptrial::test {

std::filesystem::path shipped_definition();  // experiments/force_training.toml
std::string shipped_text();
/// The shipped text with the line that starts with `key` (and what follows " =") replaced.
/// @throws std::invalid_argument where there is no such line: a test must not pass by missing it.
std::string shipped_with(const std::string& key, const std::string& line);
/// Everybody perceives, remembers and acts without error.
std::string shipped_without_noise();
std::string read_text(const std::filesystem::path& file);
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace haptrial::test
