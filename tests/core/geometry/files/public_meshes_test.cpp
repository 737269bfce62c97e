// Files as other programs write them: one solid in every dialect of the three formats, by recipe.

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cstring>
#include <fstream>
#include <functional>
#include <optional>

#include "core/base/error.h"
#include "core/geometry/files/mesh_io.h"
#include "core/geometry/volume/mesh_check.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::geometry::public_meshes_test {
namespace {

using ::testing::HasSubstr;

constexpr double kArea = 30.0;  // of the prism: twice 7, and 16 around it
constexpr double kVolume = 7.0;

/// Corners of an upright prism over an L: six below, six above.
constexpr std::array<std::array<int, 2>, 6> kOutline{
    {{4, 1}, {1, 1}, {1, 4}, {0, 4}, {0, 0}, {4, 0}}};

std::vector<std::vector<int>> polygons() {
  std::vector<std::vector<int>> faces{{5, 4, 3, 2, 1, 0}, {6, 7, 8, 9, 10, 11}};
  for (int i = 0; i < 6; ++i) {
    const int next = (i + 1) % 6;
    faces.push_back({i, next, next + 6, i + 6});
  }
  return faces;
}

/// The polygons cut by hand; the concave ones around their inner corner.
std::vector<std::vector<int>> triangles() {
  std::vector<std::vector<int>> cut;
  for (int i = 2; i < 6; ++i) {
    const int next = (i + 1) % 6;
    cut.push_back({1, next, i});
    cut.push_back({7, i + 6, next + 6});
  }
  for (std::size_t f = 2; f < 8; ++f) {
    const std::vector<int> side = polygons()[f];
    cut.push_back({side[0], side[1], side[2]});
    cut.push_back({side[0], side[2], side[3]});
  }
  return cut;
}

std::array<int, 3> corner(int number) {
  const auto at = static_cast<std::size_t>(number);
  return {kOutline[at % 6][0], kOutline[at % 6][1], number / 6};
}

using CornerText = std::function<std::string(int)>;

/// A line for each of the twelve corners.
std::string corners(const std::string& before, const std::string& after = "") {
  std::string lines;
  for (int i = 0; i < 12; ++i) {
    const auto [x, y, z] = corner(i);
    lines += fmt::format("{}{} {} {}{}\n", before, x, y, z, after);
  }
  return lines;
}

/// A line for each face.
std::string faces(const std::function<std::string(const std::vector<int>&)>& before,
                  const CornerText& one, const std::string& after = "") {
  std::string lines;
  for (const std::vector<int>& face : polygons()) {
    lines += before(face);
    for (const int i : face) {
      lines += one(i);
    }
    lines += after + "\n";
  }
  return lines;
}

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

std::string upper(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::toupper(c); });
  return text;
}

std::string obj_faces(const CornerText& one) {
  return faces([](const auto&) { return "f"; }, one);
}
std::string obj(const CornerText& one = [](int i) { return fmt::format(" {}", i + 1); }) {
  return "o prism\n" + corners("v ") + obj_faces(one);
}

std::string ply_faces() {
  return faces([](const auto& face) { return fmt::format("{}", face.size()); },
               [](int i) { return fmt::format(" {}", i); });
}

std::string ply_head(const std::string& coding, const std::string& more = "",
                     const std::string& list = "uchar int vertex_indices") {
  return fmt::format(
      "ply\nformat {} 1.0\ncomment made by recipe\nelement vertex 12\nproperty float x\n"
      "property float y\nproperty float z\n{}element face 8\nproperty list {}\nend_header\n",
      coding, more, list);
}
std::string ply_text() { return ply_head("ascii") + corners("") + ply_faces(); }

template <class T>
std::string raw(T value, bool big = false) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), &value, sizeof value);
  if (big) {
    std::ranges::reverse(bytes);
  }
  return {bytes.data(), bytes.size()};
}

std::string ply_binary(bool big) {
  std::string bytes = ply_head(big ? "binary_big_endian" : "binary_little_endian");
  for (int i = 0; i < 12; ++i) {
    for (const int value : corner(i)) {
      bytes += raw(static_cast<float>(value), big);
    }
  }
  for (const std::vector<int>& face : polygons()) {
    bytes += raw(static_cast<std::uint8_t>(face.size()));
    for (const int i : face) {
      bytes += raw(static_cast<std::int32_t>(i), big);
    }
  }
  return bytes;
}

std::string stl_text(const std::string& normal = "0 0 0") {
  std::string text = "solid prism of an L\n";
  for (const std::vector<int>& triangle : triangles()) {
    text += "  facet normal " + normal + "\n    outer loop\n";
    for (const int i : triangle) {
      const auto [x, y, z] = corner(i);
      text += fmt::format("      vertex {:e} {:e} {:e}\n", 1.0 * x, 1.0 * y, 1.0 * z);
    }
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid prism of an L\n";
}

std::string stl_binary(std::string head) {
  head.resize(80, ' ');
  std::string bytes = head + raw(static_cast<std::uint32_t>(triangles().size()));
  for (const std::vector<int>& triangle : triangles()) {
    bytes += std::string(12, '\0');
    for (const int i : triangle) {
      for (const int value : corner(i)) {
        bytes += raw(static_cast<float>(value));
      }
    }
    bytes += std::string(2, '\0');
  }
  return bytes;
}

struct File {
  std::string name;
  std::string ending;
  std::string bytes;
  std::string refusal{};    // part of the sentence
  bool assimp_errs{false};  // loses faces without a word
};

std::vector<File> obj_files() {
  const std::string plain = obj();
  const auto slashed = [](int i) { return fmt::format(" {0}/1/{0}", i + 1); };
  const auto normals = [](int i) { return fmt::format(" {}//1", i + 1); };
  const auto back = [](int i) { return fmt::format(" {}", i - 12); };
  return {
      {"polygons", "obj", plain},
      {"corners counted backwards", "obj", obj(back)},
      {"texture and normals", "obj", "vt 0 0\n" + obj(slashed)},
      {"normals alone", "obj", "vn 0 0 1\n" + obj(normals)},
      {"lines of DOS", "obj", replaced(plain, "\n", "\r\n")},
      {"lines of old Macs", "obj", replaced(plain, "\n", "\r")},
      {"tabs and blanks", "obj", replaced(replaced(plain, " ", "\t "), "\n", "  \n\n")},
      {"lines that go on", "obj", replaced(plain, " 4\n", " \\\n4\n")},
      {"mark and comments", "obj", "\xEF\xBB\xBF# by hand\n" + replaced(plain, "\nf", "\n#\nf")},
      {"groups and materials", "obj",
       "mtllib a.mtl\ng one two\nusemtl red\ns off\n" + plain + "l 1 2\np 3\n"},
      {"a face of two corners", "obj", plain + "f 1 2\n"},
      {"colours of corners", "obj", "o prism\n" + corners("v ", " 1 0 0.5") + obj_faces([](int i) {
                                      return fmt::format(" {}", i + 1);
                                    })},
      {"powers of ten", "obj", replaced(plain, "v 4", "v +0.4E+01")},
      {"a corner that is missing", "obj", plain + "f 1 2 13\n", "the corner 13; allowed: 1 to 12"},
      {"no face", "obj", corners("v "), "has no triangle"},
  };
}

std::vector<File> ply_files() {
  const std::string extra = "property uchar red\nproperty list uchar float tags\n";
  const std::string edges = "element edge 1\nproperty int a\nproperty int b\n";
  const std::string first =
      "ply\nformat ascii 1.0\nelement face 8\nproperty list uchar uint vertex_index\n"
      "element vertex 12\nproperty double x\nproperty double y\nproperty double z\nend_header\n";
  const std::string strips = replaced(ply_head("ascii"), "element face 8", "element tristrips 1") +
                             corners("") + "4 0 1 2 -1\n";
  return {
      {"text", "ply", ply_text()},
      {"lines of DOS", "ply", replaced(ply_text(), "\n", "\r\n")},
      {"lines of old Macs", "ply", replaced(ply_text(), "\n", "\r")},
      {"least byte first", "ply", ply_binary(false)},
      {"greatest byte first", "ply", ply_binary(true)},
      {"more of each corner", "ply",
       ply_head("ascii", extra) + corners("", " 200 2 0.5 0.5") + ply_faces()},
      {"edges", "ply", ply_head("ascii", edges) + corners("") + "0 1\n" + ply_faces()},
      {"other types", "ply",
       ply_head("ascii", "", "ushort uint32 vertex_index") + corners("") + ply_faces()},
      {"faces first", "ply", first + ply_faces() + corners("")},
      {"strips", "ply", strips, "given as strips of triangles"},
      {"cut off", "ply", ply_binary(false).substr(0, 400), "which the file has left"},
  };
}

std::vector<File> stl_files() {
  const std::string text = stl_text();
  const std::string binary = stl_binary("made by recipe");
  const std::string named = stl_binary("solid by its first word");
  return {
      {"text", "stl", text},
      {"lines of DOS", "stl", replaced(text, "\n", "\r\n")},
      {"lines of old Macs", "stl", replaced(text, "\n", "\r")},
      {"one line", "stl", replaced(text, "\n", " ")},
      {"capitals", "stl", upper(text)},
      {"normals that are no numbers", "stl", stl_text("nan nan nan")},
      {"no name", "stl", replaced(text, " prism of an L", "")},
      {"binary", "stl", binary},
      {"binary that begins with solid", "stl", named},
      {"binary with bytes behind", "stl", binary + "made in a workshop"},
      {"binary that begins with solid, with bytes behind", "stl", named + "made in a workshop", "",
       true},
      {"binary that is cut off", "stl", named.substr(0, 900), "20 triangles by its header"},
      {"text that is cut off", "stl", text.substr(0, 700), "the file ends"},
  };
}

std::vector<File> all_files() {
  std::vector<File> all;
  for (const auto& part : {obj_files(), ply_files(), stl_files()}) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

TEST(PublicMeshesTest, EveryDialectIsTheSameSolidOrRefused) {
  for (const File& file : all_files()) {
    SCOPED_TRACE(file.ending + ": " + file.name);
    const MeshFormat format = mesh_format("m." + file.ending);
    if (!file.refusal.empty()) {
      try {
        parse_mesh(file.bytes, format, "m");
        ADD_FAILURE() << "read";
      } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr(file.refusal));
      }
      continue;
    }
    const MeshReport report = check_mesh(parse_mesh(file.bytes, format, "m"));
    EXPECT_TRUE(report.closed && report.manifold() && report.oriented());
    EXPECT_NEAR(report.area, kArea, 1e-9);
    EXPECT_NEAR(report.volume, kVolume, 1e-9);
  }
}

TEST(PublicMeshesTest, EndingsMayBeInCapitals) {
  const test::TemporaryFolder folder;
  for (const File& file : {obj_files()[0], ply_files()[3], stl_files()[7]}) {
    const auto path = folder / ("PRISM." + upper(file.ending));
    std::ofstream(path, std::ios::binary) << file.bytes;
    EXPECT_NEAR(check_mesh(read_mesh(path)).volume, kVolume, 1e-9) << file.ending;
  }
}

/// The area that assimp finds; nothing if it does not read the file.
std::optional<double> area_by_assimp(const File& file) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFileFromMemory(file.bytes.data(), file.bytes.size(),
                                                     aiProcess_Triangulate, file.ending.c_str());
  if (scene == nullptr) {
    return std::nullopt;
  }
  double area = 0.0;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& mesh = *scene->mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      if (mesh.mFaces[f].mNumIndices == 3) {
        const unsigned* i = mesh.mFaces[f].mIndices;
        const aiVector3D along = mesh.mVertices[i[1]] - mesh.mVertices[i[0]];
        const aiVector3D beside = mesh.mVertices[i[2]] - mesh.mVertices[i[0]];
        area += 0.5 * static_cast<double>((along ^ beside).Length());
      }
    }
  }
  return area;
}

TEST(PublicMeshesTest, AssimpFindsTheSameSolid) {
  int judged = 0;
  for (const File& file : all_files()) {
    if (!file.refusal.empty() || file.assimp_errs) {
      continue;
    }
    if (const std::optional<double> area = area_by_assimp(file)) {
      EXPECT_NEAR(*area, kArea, 1e-5) << file.ending << ": " << file.name;
      ++judged;
    }
  }
  EXPECT_GE(judged, 25);
}

}  // namespace
}  // namespace haptrial::geometry::public_meshes_test
