#include "core/base/file_text.h"

#include <fmt/format.h>

#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>

#include "core/base/error.h"

namespace haptrial {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void refuse_unread(const fs::path& file) {
  throw InputError(fmt::format("{}: cannot be read: {}", file.string(),
                               std::system_category().message(errno == 0 ? EIO : errno)));
}

}  // namespace

void refuse_special_file(const fs::path& file) {
  std::error_code missing;
  const fs::file_status status = fs::status(file, missing);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw InputError(fmt::format("{}: is {}; give a file", file.string(),
                                 fs::is_directory(status) ? "a directory" : "not a regular file"));
  }
}

std::string file_text(const fs::path& file) {
  refuse_special_file(file);
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  // An empty file gives no character to <<, which takes that for a failure.
  const bool empty = in && in.peek() == std::ifstream::traits_type::eof() && !in.bad();
  if (!in.is_open() || !(empty || text << in.rdbuf())) {
    refuse_unread(file);
  }
  return std::move(text).str();
}

std::string file_head(const fs::path& file, std::size_t most) {
  refuse_special_file(file);
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  std::string head(most, '\0');
  in.read(head.data(), static_cast<std::streamsize>(most));
  if (!in.is_open() || in.bad()) {
    refuse_unread(file);
  }
  head.resize(static_cast<std::size_t>(in.gcount()));
  return head;
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
