#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

namespace haptrial::experiments {

/// The text of a file and what tells whether the file still has it.
struct StampedText {
  std::string text;
  std::string stamp;  // of its bytes, 16 hexadecimal digits
};

/// The one folder that the studio shows. Every name is relative to it, has '/' between its parts
/// and leads nowhere else: no "..", no hidden file, no symbolic link that leads out. Any thread.
class StudyFolder {
 public:
  /// @throws InputError if it is not a folder.
  explicit StudyFolder(const std::filesystem::path& folder);

  const std::filesystem::path& path() const { return root_; }

  /// A file or folder that is there, without symbolic links.
  /// @throws InputError for a name that leads elsewhere or to nothing.
  std::filesystem::path inside(const std::string& name) const;
  /// Whether inside() gives the name.
  bool holds(const std::string& name) const;
  /// Looks for a definition in the same way. @throws InputError also for a name that does not end
  /// in .toml.
  std::filesystem::path definition(const std::string& name) const;

  /// Names of the definitions at the top of the folder, in order. Files of a lab, and of texts in
  /// another language, are none.
  std::vector<std::string> definitions() const;

  /// Names of the folders of a definition's sessions and rehearsals, in order: out/STEM,
  /// out/STEM-001 and out/STEM-rehearsal-001, as commands and the studio name them. A folder whose
  /// name begins with the longer stem of another definition is that one's.
  std::vector<std::string> session_folders(const std::string& definition) const;
  /// Names of the folders that the studio exported such folders to, in order: out/STEM-csv-001,
  /// out/STEM-rehearsal-001-bids-001 and the like.
  std::vector<std::string> export_folders(const std::string& definition) const;
  /// Where sessions with people go: "out/STEM"; need not be there.
  static std::string sessions_of(const std::string& definition);
  /// The first name of a folder for a purpose that is free: "out/STEM-rehearsal-001".
  std::string fresh_folder(const std::string& definition, const std::string& purpose) const;

  /// @throws InputError for a file of more than `most` bytes.
  StampedText read(const std::filesystem::path& file, std::uintmax_t most) const;
  /// Replaces a definition, whole or not at all; of those who save at once with one stamp, the
  /// first does. @returns its new stamp
  /// @throws InputError if the file no longer has `stamp`.
  std::string save(const std::string& name, const std::string& text,
                   const std::string& stamp) const;

 private:
  /// Names of folders in out/ that begin with the definition's stem and go on as the pattern says.
  std::vector<std::string> folders_like(const std::string& definition, const char* pattern) const;

  std::filesystem::path root_;  // without symbolic links
  mutable std::mutex saving_;
};

}  // namespace haptrial::experiments
