// Faces with more than three corners: their triangles cover the face and nothing else.

#include "core/geometry/files/cut_face.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>

#include "core/base/error.h"
#include "core/geometry/files/mesh_io.h"
#include "core/geometry/volume/mesh_check.h"

namespace haptrial::geometry {
namespace {

using ::testing::HasSubstr;
using Polygon = std::vector<Eigen::Vector2d>;

const Polygon kAngle{{4, 1}, {1, 1}, {1, 4}, {0, 4}, {0, 0}, {4, 0}};

/// A prism of height 1 over a polygon whose first corner in the file is `first`.
struct Prism {
  Polygon corners;
  std::size_t first{0};

  std::vector<std::vector<std::size_t>> faces() const {
    const std::size_t n = corners.size();
    std::vector<std::vector<std::size_t>> all(2);
    for (std::size_t i = 0; i < n; ++i) {
      all[0].push_back((first + n - i) % n);
      all[1].push_back((first + i) % n + n);
      all.push_back({i, (i + 1) % n, (i + 1) % n + n, i + n});
    }
    return all;
  }
  std::string points(const std::string& start) const {
    std::string text;
    for (const int z : {0, 1}) {
      for (const Eigen::Vector2d& p : corners) {
        text += fmt::format("{}{} {} {}\n", start, p.x(), p.y(), z);
      }
    }
    return text;
  }
  std::string rows(const std::string& start, bool counted, std::size_t from) const {
    std::string text;
    for (const auto& face : faces()) {
      text += start + (counted ? fmt::format("{}", face.size()) : "");
      for (const std::size_t corner : face) {
        text += fmt::format(" {}", corner + from);
      }
      text += '\n';
    }
    return text;
  }
  std::string bytes(MeshFormat format) const {
    const std::size_t n = corners.size();
    if (format == MeshFormat::kObj) {  // a vertex may come after its face
      return rows("f", false, 1) + points("v ");
    }
    return fmt::format(
               "ply\nformat ascii 1.0\nelement face {}\nproperty list uchar int vertex_index\n"
               "element vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
               "end_header\n",
               n + 2, 2 * n) +
           rows("", true, 0) + points("");
  }
};

double area(const Mesh& mesh) {
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const auto& v = mesh.vertices;
    sum += 0.5 * (v[t[1]] - v[t[0]]).cross(v[t[2]] - v[t[0]]).norm();
  }
  return sum;
}

std::string refusal_of_prism(const Prism& prism) {
  try {
    parse_mesh(prism.bytes(MeshFormat::kObj), MeshFormat::kObj, "m");
  } catch (const InputError& error) {
    return error.what();
  }
  return "read";
}

TEST(CutFaceTest, AConcaveFaceHasItsAreaFromEveryFirstCornerInEveryFormat) {
  for (const MeshFormat format : {MeshFormat::kObj, MeshFormat::kPly}) {
    for (std::size_t first = 0; first < kAngle.size(); ++first) {
      const Mesh mesh = parse_mesh(Prism{kAngle, first}.bytes(format), format, "m");
      EXPECT_NEAR(area(mesh), 30.0, 1e-9) << first;  // twice 7, and 16 for the sides
      const MeshReport report = check_mesh(mesh);
      EXPECT_TRUE(report.closed && report.manifold() && report.oriented()) << first;
    }
  }
}

TEST(CutFaceTest, StarsAndCombsOfManyCornersHaveTheirArea) {
  Polygon star;
  Polygon comb;
  constexpr int kTeeth = 60;
  for (int i = 0; i < 2 * kTeeth; ++i) {
    const double angle = std::numbers::pi * i / kTeeth;
    const double radius = i % 2 == 0 ? 3.0 : 1.0;
    star.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  comb.emplace_back(0.0, 0.0);
  comb.emplace_back(kTeeth, 0.0);
  for (int i = kTeeth; i > 0; --i) {
    comb.insert(comb.end(), {{i, 5.0}, {i - 0.5, 5.0}, {i - 0.5, 1.0}, {i - 1.0, 1.0}});
  }
  for (const Polygon& corners : {star, comb}) {
    double exact = 0.0;  // Gauss's formula, and the sides
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Eigen::Vector2d& a = corners[i];
      const Eigen::Vector2d& b = corners[(i + 1) % corners.size()];
      exact += a.x() * b.y() - a.y() * b.x() + (b - a).norm();
    }
    const Prism prism{corners, 7};
    EXPECT_NEAR(area(parse_mesh(prism.bytes(MeshFormat::kObj), MeshFormat::kObj, "m")), exact,
                1e-9 * exact);
  }
}

TEST(CutFaceTest, AFaceWithAHoleThroughABridgeIsCut) {
  const Polygon framed{{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0},
                       {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}};
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::int32_t> corners;
  for (const Eigen::Vector2d& p : framed) {
    corners.push_back(static_cast<std::int32_t>(vertices.size()));
    vertices.emplace_back(p.x(), 2.0, -p.y());  // seen from +y
  }
  Mesh mesh{vertices, std::vector<Triangle>(framed.size() - 2)};
  reading::FaceCutter cutter;
  ASSERT_STREQ(cutter.cut(vertices, corners, mesh.triangles), "");
  EXPECT_DOUBLE_EQ(area(mesh), 12.0);
}

TEST(CutFaceTest, AConcaveFaceFarFromTheOriginHasItsArea) {
  for (const double far : {1e3, 1e5, 4e6, 1e9}) {
    Polygon moved = kAngle;
    for (Eigen::Vector2d& corner : moved) {
      corner += Eigen::Vector2d(0.125 * far, far);
    }
    for (std::size_t first = 0; first < moved.size(); ++first) {
      const Mesh mesh =
          parse_mesh(Prism{moved, first}.bytes(MeshFormat::kObj), MeshFormat::kObj, "m");
      EXPECT_NEAR(area(mesh), 30.0, 1e-9) << far << " from corner " << first;
    }
  }
}

/// Single precision moves the corners of a face by more than its folds.
TEST(CutFaceTest, AFaceThatRoundingFoldsFarFromTheOriginIsRead) {
  EXPECT_EQ(
      refusal_of_prism(
          {{{1e6, 0.0}, {1e6 + 1.0, 0.0}, {1e6 + 1.0, 0.0625}, {1e6 + 0.5, -0.01}, {1e6, 0.0625}}}),
      "read");
}

TEST(CutFaceTest, AFaceThatCrossesItselfIsNamed) {
  EXPECT_THAT(refusal_of_prism({{{0, 0}, {4, 0}, {0, 3}, {4, 4}}}),
              HasSubstr("m: face 1 with 4 corners crosses itself"));
  Polygon pentagram;
  for (int i = 0; i < 5; ++i) {
    const double angle = 0.8 * std::numbers::pi * i;
    pentagram.emplace_back(std::cos(angle), std::sin(angle));
  }
  EXPECT_THAT(refusal_of_prism({pentagram}), HasSubstr("crosses itself"));
}

TEST(CutFaceTest, AFoldAsThinAsRoundingIsRead) {
  EXPECT_EQ(refusal_of_prism({{{0, 0}, {1, 0}, {2, 1e-9}, {3, 0}, {2, -1e-9}, {2, 1}}}), "read");
}

}  // namespace
}  // namespace haptrial::geometry
