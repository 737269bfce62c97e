#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

/// The little of HDF5 that geometry writes; hdf5.h stays in the source.
namespace haptrial::geometry::h5 {

enum class Number { kU8, kI32, kF32, kF64 };

/// A new file, replacing what is at the path. Calls of all threads take turns.
class File {
 public:
  /// @throws RunError, as all of these, naming the file.
  explicit File(std::filesystem::path path);
  ~File();
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  void write(const char* dataset, Number type, const std::vector<std::uint64_t>& shape,
             const void* values);
  void put(const char* dataset, const char* attribute, const std::string& text);
  void put(const char* dataset, const char* attribute, const std::vector<double>& values);
  void close();

 private:
  [[noreturn]] void fail(const char* what) const;
  std::filesystem::path path_;
  std::int64_t id_;
};

}  // namespace haptrial::geometry::h5
