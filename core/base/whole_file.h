#pragma once

#include <cstdio>
#include <filesystem>
#include <span>
#include <string_view>

namespace haptrial {

/// A file that is written whole or not at all: the bytes go to FILE.partial-N beside it, which
/// takes its name in finish(). Without that, or when the program is told to stop, nothing is left.
/// A file that is replaced keeps its owner and group as far as the system allows it, and its mode;
/// without its group, nobody gains access. The target of a symbolic link is replaced.
class WholeFile {
 public:
  /// @param overwrite  replace a file that is there
  /// @param ending     what the part's name ends with, for programs that look at it: ".mp4"
  /// @throws InputError if the file is there or cannot be made.
  explicit WholeFile(std::filesystem::path file, bool overwrite = false,
                     std::string_view ending = "");
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  /// @throws RunError in the words of the system, as on a full disk.
  void write(std::string_view bytes);
  template <class T>
  void write_all(std::span<const T> values) {
    write({reinterpret_cast<const char*>(values.data()), values.size_bytes()});
  }
  /// Ends the writing without waiting for the disk, or lets another writer have the part; finish()
  /// then only gives it its name. @throws RunError
  void close();
  /// @throws RunError; InputError when a file that may not be replaced came meanwhile.
  void finish();

  const std::filesystem::path& file() const { return file_; }
  /// The file under its present name, for libraries that open it themselves.
  const std::filesystem::path& part() const { return part_; }

 private:
  [[noreturn]] void fail(const char* what, int error) const;

  std::filesystem::path file_;
  std::filesystem::path target_;  // of file_, if that is a symbolic link; else file_
  std::filesystem::path part_;
  bool overwrite_;
  bool finished_{false};
  std::FILE* stream_{nullptr};
};

/// Replaces a file, whole or not at all. @throws as WholeFile does
void write_whole(const std::filesystem::path& file, std::string_view bytes);

/// Gives a file a name that no other file has; unlike std::rename it never replaces one.
/// @returns 0, or errno: EEXIST if there is a file of the name.
int rename_to_new(const std::filesystem::path& from, const std::filesystem::path& to) noexcept;

}  // namespace haptrial
