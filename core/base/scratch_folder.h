#pragma once

#include <filesystem>
#include <string_view>

namespace haptrial {

/// A folder of this process alone, gone at the end.
class ScratchFolder {
 public:
  /// @param what  for the folder's name: "haptrial-WHAT-XXXXXX" among the system's temporary files
  /// @throws RunError if it cannot be made.
  explicit ScratchFolder(std::string_view what);
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace haptrial
