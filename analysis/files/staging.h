#pragma once

#include <filesystem>
#include <string>

namespace haptrial::analysis {

/// A folder within the final one, so that moving a file out of it is a rename. Gone at the end.
class Staging {
 public:
  /// @throws InputError where the final folder is not there and cannot be made, or not be written.
  explicit Staging(const std::filesystem::path& folder);
  ~Staging();
  Staging(const Staging&) = delete;
  Staging& operator=(const Staging&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// @throws RunError
  void write(const std::string& name, const std::string& text) const;
  /// Adds to a file that is as long as a study. @throws RunError
  void append(const std::string& name, const std::string& text) const;
  /// Moves everything to its place, each file at once. @throws RunError
  void publish() const;

 private:
  std::filesystem::path final_;
  std::filesystem::path path_;
};

}  // namespace haptrial::analysis
