#include "core/geometry/files/mesh_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include "core/base/whole_file.h"
#include "core/geometry/files/mesh_text_internal.h"

namespace haptrial::geometry {
namespace fs = std::filesystem;
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

std::string contents(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    throw InputError(
        fmt::format("{}: {}; choose a mesh file", file.string(),
                    fs::exists(file, error) ? "is not a regular file" : "no such file"));
  }
  const std::unique_ptr<std::FILE, CloseFile> stream(std::fopen(file.c_str(), "rb"));
  const auto size = fs::file_size(file, error);
  if (!stream || error) {
    throw InputError(fmt::format("{}: cannot be read: {}", file.string(),
                                 std::system_category().message(errno)));
  }
  std::string bytes(size, '\0');
  if (std::fread(bytes.data(), 1, size, stream.get()) != size) {
    throw InputError(fmt::format("{}: became shorter while it was read", file.string()));
  }
  return bytes;
}

}  // namespace

MeshFormat mesh_format(const fs::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (ending == ".obj") {
    return MeshFormat::kObj;
  }
  if (ending == ".ply") {
    return MeshFormat::kPly;
  }
  if (ending == ".stl") {
    return MeshFormat::kStl;
  }
  throw InputError(fmt::format("{}: ends in '{}'; allowed: .obj, .ply, .stl", file.string(),
                               file.extension().string()));
}

Mesh parse_mesh(std::string_view bytes, MeshFormat format, std::string_view name,
                const WorkReport& report) {
  if (bytes.empty()) {
    throw InputError(fmt::format("{}: is empty; choose a mesh with triangles", name));
  }
  Mesh mesh;
  switch (format) {
    case MeshFormat::kObj:
      mesh = reading::read_obj(bytes, name, report);
      break;
    case MeshFormat::kPly:
      mesh = reading::read_ply(bytes, name, report);
      break;
    case MeshFormat::kStl:
      mesh = reading::read_stl(bytes, name, report);
      break;
  }
  if (mesh.triangles.empty()) {
    throw InputError(fmt::format("{}: has no triangle; choose a mesh with triangles", name));
  }
  return mesh;
}

Mesh read_mesh(const fs::path& file, const WorkReport& report) {
  const MeshFormat format = mesh_format(file);
  return parse_mesh(contents(file), format, file.string(), report);
}

void write_mesh(const fs::path& file, const Mesh& mesh, bool overwrite) {
  const MeshFormat format = mesh_format(file);
  WholeFile out(file, overwrite);
  out.write(encode_mesh(mesh, format));
  out.finish();
}

std::uint64_t reading_memory(std::uint64_t file_bytes, MeshFormat format) {
  // A vertex takes 24 bytes, a triangle 12, a face of four corners 24 beside its triangles, thrice
  // that while a vector grows. The shortest ways to write them: "v 0 0 0\n", and " 1" for one more
  // corner of a face in text, one byte for it in PLY; 50 bytes a triangle with up to three new
  // vertices and their slots in STL.
  constexpr std::uint64_t kText = 36;
  constexpr std::uint64_t kPly = 54;
  constexpr std::uint64_t kStl = 6;
  switch (format) {
    case MeshFormat::kPly:
      return kPly * file_bytes;
    case MeshFormat::kStl:
      return kStl * file_bytes;
    case MeshFormat::kObj:
      break;
  }
  return kText * file_bytes;
}

}  // namespace haptrial::geometry
