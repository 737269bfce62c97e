#include <fmt/format.h>

#include <Eigen/Geometry>

#include <iterator>

#include "core/geometry/files/mesh_io.h"

namespace haptrial::geometry {
namespace {

using Buffer = fmt::memory_buffer;

template <class T>
void put(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string encode_obj(const Mesh& mesh) {
  Buffer out;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    fmt::format_to(std::back_inserter(out), "v {} {} {}\n", v.x(), v.y(), v.z());
  }
  for (const Triangle& t : mesh.triangles) {
    fmt::format_to(std::back_inserter(out), "f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  }
  return fmt::to_string(out);
}

std::string encode_ply(const Mesh& mesh) {
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\n"
      "property double y\nproperty double z\nelement face {}\n"
      "property list uchar int vertex_indices\nend_header\n",
      mesh.vertices.size(), mesh.triangles.size());
  bytes.reserve(bytes.size() + 24 * mesh.vertices.size() + 13 * mesh.triangles.size());
  for (const Eigen::Vector3d& v : mesh.vertices) {
    bytes.append(reinterpret_cast<const char*>(v.data()), 3 * sizeof(double));
  }
  for (const Triangle& t : mesh.triangles) {
    put(bytes, std::uint8_t{3});
    put(bytes, t);
  }
  return bytes;
}

std::string encode_stl(const Mesh& mesh) {
  std::string bytes = "binary STL, haptrial";
  bytes.resize(80, ' ');
  put(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  bytes.reserve(bytes.size() + 50 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.vertices[t[0]];
    const Eigen::Vector3d edge_1 = mesh.vertices[t[1]] - a;
    const Eigen::Vector3d edge_2 = mesh.vertices[t[2]] - a;
    const Eigen::Vector3f normal = edge_1.cross(edge_2).stableNormalized().cast<float>();
    put(bytes, std::array<float, 3>{normal.x(), normal.y(), normal.z()});
    for (const std::int32_t corner : t) {
      const Eigen::Vector3f p = mesh.vertices[corner].cast<float>();
      put(bytes, std::array<float, 3>{p.x(), p.y(), p.z()});
    }
    put(bytes, std::uint16_t{0});
  }
  return bytes;
}

}  // namespace

std::string encode_mesh(const Mesh& mesh, MeshFormat format) {
  switch (format) {
    case MeshFormat::kPly:
      return encode_ply(mesh);
    case MeshFormat::kStl:
      return encode_stl(mesh);
    case MeshFormat::kObj:
      break;
  }
  return encode_obj(mesh);
}

}  // namespace haptrial::geometry
