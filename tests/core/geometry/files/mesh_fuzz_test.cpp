#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/geometry/files/mesh_io.h"
#include "core/geometry/mesh/procedural.h"
#include "core/geometry/volume/mesh_check.h"
#include "core/geometry/volume/mesh_repair.h"
#include "tests/core/geometry/files/mutations.h"

namespace haptrial::geometry {
namespace {

std::vector<std::string> seeds(MeshFormat format) {
  const Mesh sphere = make_sphere(1.0, 2);
  std::vector<std::string> all{encode_mesh(sphere, format),
                               encode_mesh(make_torus(1, 0.3, 3, 3), format)};
  if (format == MeshFormat::kObj) {
    all.push_back("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2//1 -1\nf 1 2 \\\n3\n");
  } else if (format == MeshFormat::kPly) {
    all.push_back(
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nproperty list uchar int tags\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n0 0 0 0\n1 0 0 1 5\n0 1 0 0\n3 0 1 "
        "2\n");
    std::string big = all[0];
    big.replace(big.find("little"), 6, "big");
    all.push_back(big);
  } else {
    all.push_back(
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
        "endloop\nendfacet\nendsolid a\n");
  }
  return all;
}

/// Promises of a reader about a mesh that it gives.
void expect_whole(const Mesh& mesh) {
  ASSERT_FALSE(mesh.triangles.empty());
  for (const Eigen::Vector3d& v : mesh.vertices) {
    ASSERT_LE(v.cwiseAbs().maxCoeff(), kMaxCoordinate);
  }
  for (const Triangle& t : mesh.triangles) {
    for (const std::int32_t corner : t) {
      ASSERT_TRUE(corner >= 0 && corner < static_cast<std::int32_t>(mesh.vertices.size()));
    }
  }
}

class MeshFuzzTest : public ::testing::TestWithParam<MeshFormat> {};

TEST_P(MeshFuzzTest, SpoiledFilesGiveAMeshOrASentence) {
  constexpr int kFiles = 5000;
  const std::vector<std::string> originals = seeds(GetParam());
  RandomStream random(static_cast<std::uint64_t>(GetParam()), "spoiled meshes");
  int read = 0;
  for (int i = 0; i < kFiles; ++i) {
    std::string bytes = originals[random.below(originals.size())];
    for (std::uint64_t times = 1 + random.below(4); times > 0; --times) {
      mutate(bytes, random);
    }
    try {
      Mesh mesh = parse_mesh(bytes, GetParam(), "m");
      ++read;
      ASSERT_NO_FATAL_FAILURE(expect_whole(mesh)) << "file " << i;
      // The finite words of a report, whatever the mesh is like; and repair takes anything.
      const MeshReport report = check_mesh(mesh);
      ASSERT_TRUE(std::isfinite(report.area) && std::isfinite(report.volume)) << "file " << i;
      repair(mesh);
      const MeshReport after = check_mesh(mesh);
      ASSERT_EQ(
          after.repeated_corner_triangles + after.duplicate_triangles + after.unreferenced_vertices,
          0u)
          << "file " << i;
    } catch (const InputError& error) {
      const std::string sentence = error.what();
      const auto printable = [](char c) { return c >= ' ' && c <= '~'; };
      ASSERT_TRUE(std::all_of(sentence.begin(), sentence.end(), printable)) << "file " << i;
      ASSERT_LT(sentence.size(), 250u) << "file " << i << ": " << sentence;
    }
  }
  EXPECT_GT(read, kFiles / 50) << "some survive";
  EXPECT_LT(read, kFiles - kFiles / 50) << "some do not";
}

TEST_P(MeshFuzzTest, EveryBeginningOfAFileGivesAMeshOrASentence) {
  const std::string whole = seeds(GetParam())[2];
  for (std::size_t size = 0; size < whole.size(); ++size) {
    try {
      expect_whole(parse_mesh(whole.substr(0, size), GetParam(), "m"));
    } catch (const InputError&) {
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, MeshFuzzTest,
                         ::testing::Values(MeshFormat::kObj, MeshFormat::kPly, MeshFormat::kStl));

}  // namespace
}  // namespace haptrial::geometry
