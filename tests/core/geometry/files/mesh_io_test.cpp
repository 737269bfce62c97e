#include "core/geometry/files/mesh_io.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstring>

#include "core/base/error.h"
#include "core/geometry/mesh/procedural.h"
#include "core/geometry/volume/mesh_check.h"
#include "tests/support/shared_data.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::geometry {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const char* ending(MeshFormat format) {
  constexpr std::array<const char*, 3> kEndings{"obj", "ply", "stl"};
  return kEndings[static_cast<std::size_t>(format)];
}

/// The triangles by the places of their corners, turned so that the least is first, in order.
using Places = std::vector<std::array<std::array<float, 3>, 3>>;
Places places(const Mesh& mesh) {
  Places all;
  for (const Triangle& t : mesh.triangles) {
    std::array<std::array<float, 3>, 3> one;
    for (std::size_t c = 0; c < 3; ++c) {
      const Eigen::Vector3f p = mesh.vertices[t[c]].cast<float>();
      one[c] = {p.x(), p.y(), p.z()};
    }
    std::rotate(one.begin(), std::min_element(one.begin(), one.end()), one.end());
    all.push_back(one);
  }
  std::sort(all.begin(), all.end());
  return all;
}

std::string refusal(std::string_view bytes, MeshFormat format) {
  try {
    parse_mesh(bytes, format, "m");
  } catch (const InputError& error) {
    return error.what();
  }
  return "read";
}

class MeshFormatsTest : public ::testing::TestWithParam<MeshFormat> {};

TEST_P(MeshFormatsTest, AMeshComesBackAsItWas) {
  Mesh mesh = make_rough_solid(0.1, 12, 3);
  mesh.vertices.push_back({1.0 / 3.0, -1e-9, 12345.678});  // unreferenced
  const Mesh back = parse_mesh(encode_mesh(mesh, GetParam()), GetParam(), "m");
  if (GetParam() == MeshFormat::kStl) {  // floats, and vertices made from the corners
    EXPECT_EQ(places(back), places(mesh));
    EXPECT_EQ(back.vertices.size(), mesh.vertices.size() - 1);
  } else {
    EXPECT_EQ(back.vertices, mesh.vertices) << "every bit of every double";
    EXPECT_EQ(back.triangles, mesh.triangles);
  }
}

TEST_P(MeshFormatsTest, AssimpReadsWhatWeWrite) {
  const Mesh mesh = make_gear();
  const std::string bytes = encode_mesh(mesh, GetParam());
  Assimp::Importer importer;
  const aiScene* scene =
      importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, ending(GetParam()));
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  ASSERT_EQ(scene->mNumMeshes, 1u);
  const aiMesh& read = *scene->mMeshes[0];
  Mesh theirs;
  for (unsigned v = 0; v < read.mNumVertices; ++v) {
    theirs.vertices.emplace_back(read.mVertices[v].x, read.mVertices[v].y, read.mVertices[v].z);
  }
  for (unsigned f = 0; f < read.mNumFaces; ++f) {
    ASSERT_EQ(read.mFaces[f].mNumIndices, 3u);
    const unsigned* corner = read.mFaces[f].mIndices;
    theirs.triangles.push_back({static_cast<std::int32_t>(corner[0]),
                                static_cast<std::int32_t>(corner[1]),
                                static_cast<std::int32_t>(corner[2])});
  }
  const Places ours = places(mesh);
  const Places other = places(theirs);
  ASSERT_EQ(other.size(), ours.size());
  for (std::size_t t = 0; t < ours.size(); ++t) {  // assimp's floats may differ in the last bit
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        ASSERT_NEAR(other[t][c][axis], ours[t][c][axis], 1e-8);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, MeshFormatsTest,
                         ::testing::Values(MeshFormat::kObj, MeshFormat::kPly, MeshFormat::kStl),
                         [](const auto& each) { return std::string(ending(each.param)); });

/// A torus as assimp writes it, in its text and binary variants.
TEST(MeshIoTest, WhatAssimpWritesIsReadTheSame) {
  const std::string torus = encode_mesh(make_torus(0.5, 0.25, 12, 9), MeshFormat::kObj);
  const Places expected = places(parse_mesh(torus, MeshFormat::kObj, "torus"));
  for (const char* variant : {"obj", "ply", "plyb", "stl", "stlb"}) {
    Assimp::Importer importer;
    ASSERT_NE(importer.ReadFileFromMemory(torus.data(), torus.size(), 0, "obj"), nullptr);
    Assimp::Exporter exporter;
    const aiExportDataBlob* blob = exporter.ExportToBlob(importer.GetScene(), variant);
    ASSERT_NE(blob, nullptr) << variant << exporter.GetErrorString();
    const std::string_view bytes(static_cast<const char*>(blob->data), blob->size);
    const MeshFormat format = std::string_view(variant).starts_with("obj")   ? MeshFormat::kObj
                              : std::string_view(variant).starts_with("ply") ? MeshFormat::kPly
                                                                             : MeshFormat::kStl;
    const Places read = places(parse_mesh(bytes, format, variant));
    ASSERT_EQ(read.size(), expected.size()) << variant;
    for (std::size_t t = 0; t < read.size(); ++t) {
      for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          ASSERT_NEAR(read[t][c][axis], expected[t][c][axis], 1e-5) << variant;  // 6 digits of text
        }
      }
    }
  }
}

TEST(MeshIoTest, ObjCornersMayCountBackwardsAndCarryMore) {
  const Mesh mesh = parse_mesh(
      "\xEF\xBB\xBF# a comment\nmtllib a.mtl\nv 0 0 0 1 0.5 0.5\nv +1 0 0\r\nvt 0 0\nvn 0 0 1\n"
      "v 1 1 0\nv 0 1 0 # here\nf 1/1 2/1/1 3//1 4\nf -4 -3 \\\n -1\nusemtl x\nf 1 2 5\nv 9 9 9\n",
      MeshFormat::kObj, "m");
  EXPECT_EQ(mesh.vertices.size(), 5u);
  EXPECT_EQ(mesh.vertices[1], Eigen::Vector3d(1, 0, 0));
  EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 1, 3},
                                          Triangle{0, 1, 4}));
}

TEST(MeshIoTest, PlyElementsAndPropertiesComeInAnyOrder) {
  const Mesh mesh = parse_mesh(
      "ply\nformat ascii 1.0\ncomment x\nobj_info y\nelement camera 1\nproperty list uchar float "
      "f\n"
      "property int id\nelement face 1\nproperty uchar red\n"
      "property list uchar uint vertex_index\nelement vertex 3\nproperty float z\n"
      "property list uint8 int8 tags\nproperty double x\nproperty float y\nend_header\n"
      "2 0.5 nan 7\n200 3 0 1 2\n3 0 1 2\n6 2 -1 1 4 5\n9 1 1 7 8\n",
      MeshFormat::kPly, "m");
  EXPECT_THAT(mesh.vertices, ElementsAre(Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(4, 5, 6),
                                         Eigen::Vector3d(7, 8, 9)));
  EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}));
}

TEST(MeshIoTest, PlyOfTheOtherOrderOfBytesIsRead) {
  std::string bytes =
      "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty float x\nproperty short y\n"
      "property float z\nelement face 1\nproperty list uchar ushort vertex_indices\nend_header\n";
  for (const char last : {'\x01', '\x02', '\x03'}) {  // 1.0 is 3F 80 00 00
    bytes += std::string("\x3F\x80\x00\x00\xFF", 5) + static_cast<char>(-last) +
             std::string("\x40\x00\x00\x00", 4);
  }
  bytes += std::string("\x03\x00\x00\x00\x01\x00\x02", 7);
  const Mesh mesh = parse_mesh(bytes, MeshFormat::kPly, "m");
  EXPECT_THAT(mesh.vertices, ElementsAre(Eigen::Vector3d(1, -1, 2), Eigen::Vector3d(1, -2, 2),
                                         Eigen::Vector3d(1, -3, 2)));
  EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}));
}

TEST(MeshIoTest, StlTextSharesEqualCorners) {
  const std::string facet_1 =
      "facet normal nan nan nan\n outer loop\n vertex 0 0 0\n vertex 1 0 0\n"
      " vertex 0 1 0\n endloop\n endfacet\n";
  const std::string facet_2 =
      "FACET NORMAL 0 0 1\n OUTER LOOP\n VERTEX 1 0 0\n VERTEX 1 1 0\n VERTEX -0 1 0\n ENDLOOP\n"
      " ENDFACET\n";
  const Mesh mesh = parse_mesh("solid one\n" + facet_1 + "endsolid\nsolid\n" + facet_2 + "endsolid",
                               MeshFormat::kStl, "m");
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{1, 3, 2}));
}

TEST(MeshIoTest, BadObjGetsASentence) {
  const auto obj = [](std::string_view text) { return refusal(text, MeshFormat::kObj); };
  EXPECT_EQ(obj(""), "m: is empty; choose a mesh with triangles");
  EXPECT_EQ(obj("# nothing\n"), "m: has no triangle; choose a mesh with triangles");
  EXPECT_EQ(obj("v 0 0 0\nv 1 nan 0\n"), "m:2: a coordinate is nan; allowed: finite numbers");
  EXPECT_EQ(obj("v 0 0 1e999\n"), "m:1: a coordinate is inf; allowed: finite numbers");
  EXPECT_EQ(obj("v 0 0 1e13\n"), "m:1: a coordinate is 1e+13; allowed: -1e+12 to 1e+12");
  EXPECT_EQ(obj("v 0 0\n"), "m:1: the line ends where a coordinate of a vertex should stand");
  EXPECT_EQ(obj("v 0 0 1O\n"), "m:1: a coordinate of a vertex is '1O'; allowed: a number");
  EXPECT_EQ(obj("v 0 0 0\nf\n"), "m:2: a face has no corner; allowed: 3 or more");
  EXPECT_EQ(obj("v 0 0 0\nf 1 1 0\n"),
            "m:2: a face has the corner 0; allowed: 1 to 1, or -1 to -1");
  EXPECT_EQ(obj("v 0 0 0\nf 1 1 -2\n"),
            "m:2: a face has the corner -2; allowed: 1 to 1, or -1 to -1");
  EXPECT_EQ(obj("v 0 0 0\nf 1 1 7\nf 1 1 9\nf 1 1 8\n"),
            "m:3: a face has the corner 9; allowed: 1 to 1");
  EXPECT_THAT(obj("v 0 0 0\nf 1 1 2147483648\n"),
              StartsWith("m:2: a face has the corner 2147483648"));
  EXPECT_THAT(obj("f 1 2 99999999999999999999\n"),
              HasSubstr("allowed: a whole number that 64 bits"));
  EXPECT_EQ(
      obj("v 0 0 0\ncurv 0 1 1 2\n"),
      "m:2: 'curv' is no statement of a polygon mesh in OBJ; allowed: v, f and others of polygons");
  EXPECT_THAT(obj("\x89PNG\r\n\x1a\n\x01\x02"), StartsWith("m:1: '?PNG' is no statement"));
}

TEST(MeshIoTest, BadPlyGetsASentence) {
  const auto ply = [](std::string text) { return refusal(text, MeshFormat::kPly); };
  const std::string vertex = "property float x\nproperty float y\nproperty float z\n";
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const auto with = [&](const char* coding, const char* count) {
    return "ply\nformat " + std::string(coding) + " 1.0\nelement vertex " + count + "\n" + vertex +
           faces;
  };
  EXPECT_EQ(ply("OFF\n"), "m:1: the file begins with 'OFF'; allowed: ply");
  EXPECT_EQ(ply("ply\nformat ascii 1.0\n"), "m:2: the file ends in its header");
  EXPECT_THAT(ply("ply\nformat binary 1.0\n"), StartsWith("m:2: the format is 'binary'; allowed:"));
  EXPECT_EQ(ply("ply\nend_header\n"), "m:2: the header ends without a format");
  EXPECT_EQ(ply("ply\nproperty float x\n"), "m:2: a property stands before the first element");
  EXPECT_THAT(ply("ply\nformat ascii 1.0\nelement vertex 1\nproperty real x\n"),
              StartsWith("m:4: a property has the type 'real'; allowed:"));
  EXPECT_THAT(ply("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n" + faces),
              HasSubstr("the vertices need one property y"));
  EXPECT_THAT(ply("ply\nformat ascii 1.0\nelement vertex 0\n" + vertex + "end_header\n"),
              HasSubstr("no faces with a list vertex_indices"));
  EXPECT_THAT(ply(with("ascii", "4000000000") + "0 0 0\n"), HasSubstr("states 4000000000 rows"));
  EXPECT_THAT(ply(with("binary_little_endian", "4000000000") + "0 0 0\n"),
              AllOf(StartsWith("m: at byte "), HasSubstr("states 4000000000 rows of 'vertex'")));
  EXPECT_EQ(ply(with("ascii", "1") + "0 0 0\n3 0 0 1\n"),
            "m:11: a face has the corner 1; allowed: 0 to 0");
  EXPECT_THAT(ply(with("ascii", "1") + "0 0 0\n3 000 000\n"),
              HasSubstr("the file ends where a number"));
  EXPECT_THAT(ply(with("binary_little_endian", "1") + std::string(12, '\0') + "\x03"),
              HasSubstr("a list has 3 values; allowed: 0 to 0"));
  EXPECT_THAT(
      ply(with("binary_little_endian", "1") + std::string(12, '\xFF') + std::string(13, '\0')),
      HasSubstr("a coordinate is -nan; allowed: finite numbers"));
}

TEST(MeshIoTest, BadStlGetsASentence) {
  const auto stl = [](std::string_view text) { return refusal(text, MeshFormat::kStl); };
  std::string sphere = encode_mesh(make_sphere(1.0, 1), MeshFormat::kStl);
  EXPECT_EQ(
      stl(sphere.substr(0, 500)),
      "m: is a binary STL file with 20 triangles by its header, which take 1084 bytes; it has 500");
  EXPECT_THAT(stl("stl"), StartsWith("m: has 3 bytes and does not begin with solid"));
  EXPECT_EQ(stl("solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n"),
            "m:4: the file ends where a vertex should stand");
  EXPECT_EQ(stl("solid\nfacet normal 0 0 1\nouter ring\n"),
            "m:3: found 'ring'; allowed here: loop");
  EXPECT_EQ(stl("solid\nfacet normal 0 0 1"), "m:2: found the file's end; allowed here: outer");
  const float infinite = INFINITY;
  std::memcpy(sphere.data() + 84 + 50 * 2 + 12, &infinite, sizeof infinite);
  EXPECT_EQ(stl(sphere), "m: triangle 3: a coordinate is inf; allowed: finite numbers");
}

TEST(MeshIoTest, AMillionDegenerateTrianglesAreRead) {
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (int i = 0; i < 1000000; ++i) {
    text += i % 2 == 0 ? "f 1 1 1\n" : "f 1 2 2\n";
  }
  const Mesh mesh = parse_mesh(text, MeshFormat::kObj, "m");
  const MeshReport report = check_mesh(mesh);
  EXPECT_EQ(report.repeated_corner_triangles, 1000000u);
  EXPECT_FALSE(report.closed);
}

TEST(MeshIoTest, LongFilesSayHowFarTheyAreAndMayBeCancelled) {
  std::string text;
  for (int i = 0; i < 200000; ++i) {
    text += "v 0 0 0\n";
  }
  std::vector<double> shares;
  EXPECT_THROW(parse_mesh(text, MeshFormat::kObj, "m",
                          [&](double share) {
                            shares.push_back(share);
                            return shares.size() < 2;
                          }),
               Cancelled);
  ASSERT_EQ(shares.size(), 2u);
  EXPECT_GT(shares[0], 0.3);
  EXPECT_LT(shares[1], 0.7);
}

TEST(MeshIoTest, FilesAreWrittenWholeAndNotOverOthers) {
  const test::TemporaryFolder folder;
  const Mesh mesh = make_gear();
  write_mesh(folder / "gear.ply", mesh);
  EXPECT_EQ(read_mesh(folder / "gear.ply").triangles, mesh.triangles);
  EXPECT_THROW(write_mesh(folder / "gear.ply", mesh), InputError);
  write_mesh(folder / "gear.ply", make_sphere(1.0, 2), true);
  EXPECT_EQ(read_mesh(folder / "gear.ply").triangles.size(), 80u);
  EXPECT_THROW(write_mesh(folder / "none" / "gear.ply", mesh), InputError);
  EXPECT_THROW(write_mesh(folder / "gear.3ds", mesh), InputError);
  EXPECT_THROW(read_mesh(folder / "absent.obj"), InputError);
  EXPECT_THROW(read_mesh(folder.path()), InputError);
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    ++files;
  }
  EXPECT_EQ(files, 1u) << "nothing half-written is left";
}

TEST(MeshIoTest, TheStanfordBunnyIsOpen) {
  const auto file = test::shared_data("meshes/stanford-bunny.obj");
  if (!file) {
    GTEST_SKIP() << "neither HAPTRIAL_DATA nor ../shared/data holds meshes/stanford-bunny.obj";
  }
  const MeshReport report = check_mesh(read_mesh(*file));
  EXPECT_EQ(report.vertices, 35947u);
  EXPECT_EQ(report.triangles, 69451u);
  EXPECT_EQ(report.boundary_edges, 223u);
  EXPECT_EQ(report.unreferenced_vertices, 1113u);
  EXPECT_EQ(report.boundary_loops, 5u);
  EXPECT_EQ(report.genus, 0u);
  EXPECT_THAT(describe(report),
              ::testing::Contains(HasSubstr("open: 223 boundary edges in 5 loops")));
}

}  // namespace
}  // namespace haptrial::geometry
