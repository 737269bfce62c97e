#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>

#include "core/geometry/files/mesh_io.h"

namespace haptrial::evaluation {

/// A file that is there as long as this object: candidates read bodies from files.
class MeshFile {
 public:
  explicit MeshFile(const geometry::Mesh& mesh)
      : path_(std::filesystem::temp_directory_path() /
              ("haptrial-exam-" + std::to_string(::getpid()) + ".obj")) {
    geometry::write_mesh(path_, mesh, true);
  }
  ~MeshFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  MeshFile(const MeshFile&) = delete;
  MeshFile& operator=(const MeshFile&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace haptrial::evaluation
