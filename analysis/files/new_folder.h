#pragma once

#include <filesystem>
#include <string_view>

namespace haptrial::exchange {

/// A folder that appears whole or not at all: its files are made in a hidden folder beside it,
/// which publish() gives its name and the destructor otherwise removes.
class NewFolder {
 public:
  /// @throws InputError when `folder` holds anything, is no folder, or its parent may not be
  /// written.
  explicit NewFolder(const std::filesystem::path& folder);
  ~NewFolder();
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

  /// Path at which to make the file of this name, "sub-01/beh/x.tsv"; its folders are made. Any
  /// thread.
  std::filesystem::path place(const std::filesystem::path& name) const;
  /// @throws RunError when the disk is full.
  void write(const std::filesystem::path& name, std::string_view text) const;

  /// Publishes the folder; call once, at the end. @throws RunError when the folder has come to hold
  /// something meanwhile.
  void publish();

 private:
  std::filesystem::path final_;
  std::filesystem::path staging_;
  bool published_{false};
};

}  // namespace haptrial::exchange
