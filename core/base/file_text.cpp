#include "core/base/file_text.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "core/base/error.h"

namespace haptrial {

std::string file_text(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  // An empty file gives no character to <<, which takes that for a failure.
  const bool empty = in && in.peek() == std::ifstream::traits_type::eof() && !in.bad();
  if (!in.is_open() || !(empty || text << in.rdbuf())) {
    throw InputError(
        fmt::format("{}: cannot be read; choose a file with read permission", file.string()));
  }
  return std::move(text).str();
}

}  // namespace haptrial
