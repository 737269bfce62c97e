#include "core/base/files/file_text.h"

#include <fmt/format.h>

#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>

#include "core/base/error.h"

namespace haptrial {

std::string file_text(const std::filesystem::path& file) {
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  // An empty file gives no character to <<, which takes that for a failure.
  const bool empty = in && in.peek() == std::ifstream::traits_type::eof() && !in.bad();
  if (!in.is_open() || !(empty || text << in.rdbuf())) {
    const int why = errno == 0 ? EIO : errno;
    throw InputError(
        fmt::format("{}: cannot be read: {}", file.string(), std::system_category().message(why)));
  }
  return std::move(text).str();
}

namespace {

void put(const std::filesystem::path& file, std::string_view text,
         const std::filesystem::path& told, std::ios::openmode mode) {
  errno = 0;
  std::ofstream out(file, std::ios::binary | mode);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  if (!out) {
    throw RunError(fmt::format("{}: could not be written: {}",
                               (told.empty() ? file : told).string(),
                               std::system_category().message(errno)));
  }
}

}  // namespace

void write_text(const std::filesystem::path& file, std::string_view text,
                const std::filesystem::path& told) {
  put(file, text, told, std::ios::trunc);
}

void append_text(const std::filesystem::path& file, std::string_view text,
                 const std::filesystem::path& told) {
  put(file, text, told, std::ios::app);
}

}  // namespace haptrial
