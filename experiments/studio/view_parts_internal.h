#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <list>
#include <string>
#include <system_error>

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

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (auto at = text.find(from); at != text.npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// A definition as it is being written. It lies beside the saved one, since it may name files that
/// do, with copies of that one's texts in other languages.
class Draft {
 public:
  /// @param folder  of the studio, in which commands run
  Draft(const std::filesystem::path& definition, const std::filesystem::path& folder,
        const std::string& text)
      : stem_(definition.stem().string()),
        draft_stem_(fmt::format(".{}.draft-{}-{}", stem_, ::getpid(), next_number())),
        file_(definition.parent_path() / (draft_stem_ + ".toml")),
        name_(file_.path().lexically_relative(folder).string()) {
    if (text.size() > kMostDefinition) {
      throw InputError(
          fmt::format("the definition has {} bytes; allowed: {}", text.size(), kMostDefinition));
    }
    write_text(file_.path(), text);
    copy_translations(definition.parent_path());
  }
  const std::string& name() const { return name_; }
  /// A command's output about the draft, as it would have been about the definition.
  std::string renamed(const std::string& output) const {
    return replaced(output, draft_stem_, stem_);
  }

 private:
  void copy_translations(const std::filesystem::path& folder) {
    const std::string begin = stem_ + ".texts.";
    std::error_code ignored;  // a file that goes meanwhile
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with(begin) && name.ends_with(".toml")) {
        translations_.emplace_back(folder / (draft_stem_ + name.substr(stem_.size())));
        std::filesystem::copy_file(entry.path(), translations_.back().path(), ignored);
      }
    }
  }

  std::string stem_;
  std::string draft_stem_;
  ShortLivedFile file_;
  std::list<ShortLivedFile> translations_;
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

}  // namespace haptrial::experiments
