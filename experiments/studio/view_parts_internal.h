#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "experiments/server/server.h"

namespace haptrial::experiments {

inline constexpr std::uintmax_t kMostDefinition = 2'000'000;  // [bytes]

/// A file that is removed at the end.
class ShortLivedFile {
 public:
  explicit ShortLivedFile(std::filesystem::path file) : file_(std::move(file)) {}
  ~ShortLivedFile() {
    std::error_code ignored;
    std::filesystem::remove(file_, ignored);
  }
  ShortLivedFile(const ShortLivedFile&) = delete;
  ShortLivedFile& operator=(const ShortLivedFile&) = delete;
  const std::filesystem::path& path() const { return file_; }

 private:
  std::filesystem::path file_;
};

/// A number that no other request has.
inline int next_number() {
  static std::atomic<int> number{0};
  return ++number;
}

/// A definition as it is being written. It lies beside the saved one, since it may name files that
/// do.
class Draft {
 public:
  /// @param folder  of the studio, in which commands run
  Draft(const std::filesystem::path& definition, const std::filesystem::path& folder,
        const std::string& text)
      : file_(definition.parent_path() / fmt::format(".{}.draft-{}-{}.toml",
                                                     definition.stem().string(), ::getpid(),
                                                     next_number())),
        name_(file_.path().lexically_relative(folder).string()) {
    if (text.size() > kMostDefinition) {
      throw InputError(
          fmt::format("the definition has {} bytes; allowed: {}", text.size(), kMostDefinition));
    }
    write_text(file_.path(), text);
  }
  const std::string& name() const { return name_; }

 private:
  ShortLivedFile file_;
  std::string name_;
};

/// @throws InputError for a text that is no whole number from 0 to 999999999
inline int number_of(const std::string& text) {
  if (text.empty() || text.size() > 9 || text.find_first_not_of("0123456789") != text.npos) {
    throw InputError("a number of the address is not a whole number from 0 to 999999999");
  }
  return std::stoi(text);
}

/// The content policy of every page within a frame.
inline constexpr const char* kFramedPolicy =
    "default-src 'none'; style-src 'unsafe-inline'; img-src data:; font-src data:; "
    "frame-ancestors 'self'";

/// A report is data: it runs nothing, loads nothing, and only the studio may frame it.
inline WebAnswer framed(const std::string& type, std::string text) {
  WebAnswer answer{200, type, std::move(text)};
  answer.headers = {
      {"Content-Security-Policy", fmt::format("sandbox allow-popups; {}", kFramedPolicy)},
      {"X-Frame-Options", "SAMEORIGIN"},
      {"Cross-Origin-Opener-Policy", "unsafe-none"}};
  return answer;
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (auto at = text.find(from); at != text.npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

}  // namespace haptrial::experiments
