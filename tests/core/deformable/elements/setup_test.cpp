// A file that states a body and its loads.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>

#include "core/base/file_text.h"
#include "core/deformable/elements/setup_body.h"
#include "core/deformable/springs/spring_body.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

constexpr const char* kBlock = "[body]\nblock = [0.04, 0.02, 0.03]\nresolution = 4\n";
constexpr const char* kMaterial = "[material]\nyoung = 1e4\npoisson = 0.3\n";
constexpr const char* kRegions =
    "[regions]\nbottom.side = \"-z\"\ntop.side = \"+z\"\n"
    "far = { low = [1.0, 1.0, 1.0], high = [2.0, 2.0, 2.0] }\n"
    "half = { low = [0.0, 0.0, 0.0], high = [0.02, 0.02, 0.03] }\n"
    "ball = { centre = [0.04, 0.0, 0.03], radius = 0.011 }\n"
    "corner.nearest = [0.05, 0.0, 0.05]\n";

class SetupTest : public testing::Test {
 protected:
  DeformSetup setup(const std::string& text) {
    const auto file = folder_ / "body.toml";
    write_text(file, text);
    return read_setup(file);
  }
  DeformSetup with_load(const std::string& load) {
    return setup(std::string(kBlock) + kMaterial + kRegions + "[loads.one]\n" + load);
  }
  LoadCase load_of(const std::string& load) {
    const DeformSetup made = with_load(load);
    return load_case_of(made, made.loads.at(0), body_of(made));
  }
  std::string refusal(const std::string& text) {
    return test::message_of([&] { setup(text); });
  }
  test::TemporaryFolder folder_;
};

Vector3d sum_of(const LoadCase& load) {
  Vector3d sum = Vector3d::Zero();
  for (const NodalForce& nodal : load.forces) {
    sum += nodal.force;
  }
  return sum;
}

TEST_F(SetupTest, ABlockHasItsSidesAndVolume) {
  const auto body = body_of(setup(std::string(kBlock) + kMaterial));
  EXPECT_EQ(body.tetrahedra.size(), 5u * 4 * 2 * 3);
  Eigen::AlignedBox3d box;
  double volume = 0;
  for (const auto& t : body.tetrahedra) {
    const auto at = [&](std::size_t i) { return body.vertices[static_cast<std::size_t>(t[i])]; };
    for (std::size_t i = 0; i < 4; ++i) {
      box.extend(at(i));
    }
    volume += (at(1) - at(0)).dot((at(2) - at(0)).cross(Vector3d(at(3) - at(0)))) / 6;
  }
  EXPECT_NEAR(volume, 0.04 * 0.02 * 0.03, 1e-15);
  EXPECT_TRUE(box.min().isZero(1e-15));
  EXPECT_TRUE(box.max().isApprox(Vector3d(0.04, 0.02, 0.03), 1e-12));
}

TEST_F(SetupTest, AForceIsItsRegionsInSumAndAPressureItsArea) {
  const LoadCase load =
      load_of("held = [\"bottom\"]\nforces = [{ region = \"ball\", force = [1.0, 2.0, 3.0] }]\n");
  EXPECT_EQ(load.holds.size(), 5u * 3);
  EXPECT_EQ(load.forces.size(), 4u);  // the corner and its three neighbours
  EXPECT_TRUE(sum_of(load).isApprox(Vector3d(1, 2, 3), 1e-12));
  const LoadCase pressed =
      load_of("held = [\"bottom\"]\npressures = [{ region = \"top\", pressure = 50.0 }]\n");
  EXPECT_TRUE(sum_of(pressed).isApprox(Vector3d(0, 0, -50 * 0.04 * 0.02), 1e-12));
  const LoadCase nearest =
      load_of("held = [\"bottom\"]\nforces = [{ region = \"corner\", force = [1.0, 0.0, 0.0] }]\n");
  EXPECT_EQ(nearest.forces.size(), 1u);
}

TEST_F(SetupTest, SeveralMaterialsShareTheTetrahedra) {
  const DeformSetup made =
      setup(std::string(kBlock) + kMaterial + kRegions +
            "[materials.hard]\nyoung = 1e6\npoisson = 0.4\ndensity = 2500\nregion = \"half\"\n");
  const auto body = body_of(made);
  const Elasticity elasticity = elasticity_of(made, body);
  const SpringBody springs =
      spring_body(body, densities(elasticity, body.tetrahedra.size()), {1, 1, 1});
  const ElasticBody elements(body, elasticity);
  for (std::size_t v = 0; v < springs.masses.size(); ++v) {
    ASSERT_NEAR(springs.masses[v], elements.masses()[v], 1e-12 * springs.masses[v]) << v;
  }
  ASSERT_EQ(elasticity.materials.size(), 2u);
  EXPECT_EQ(std::count(elasticity.material_of.begin(), elasticity.material_of.end(), 1),
            static_cast<std::ptrdiff_t>(body.tetrahedra.size() / 2));
}

TEST_F(SetupTest, BadFilesGetASentence) {
  EXPECT_THAT(refusal(std::string(kBlock) + "[material]\nyoung = 1e4\npoisson = 0.5\n"),
              HasSubstr("body.toml:6: material.poisson is 0.5; allowed: above -1 and below 0.5"));
  EXPECT_THAT(refusal(std::string(kBlock) + "[material]\nyoung = 0\npoisson = 0.3\n"),
              HasSubstr("material.young is 0; allowed: a number above 0 [Pa]"));
  EXPECT_THAT(test::message_of([&] { with_load("held = [\"botom\"]\n"); }),
              HasSubstr("loads.one.held is 'botom'"));
  EXPECT_EQ(test::message_of([&] {
              load_of(
                  "held = [\"bottom\"]\nforces = [{ region = \"far\", force = [1.0, 0.0, 0.0] "
                  "}]\n");
            }),
            "load 'one': no vertex of the body is in the region 'far'");
  EXPECT_EQ(
      test::message_of([&] {
        load_of("held = [\"bottom\"]\npressures = [{ region = \"corner\", pressure = 1.0 }]\n");
      }),
      "load 'one': no outer face of the body is in the region 'corner'");
  EXPECT_THAT(test::message_of([&] {
                load_of(
                    "held = [\"bottom\"]\nmoved = [{ region = \"bottom\", by = [0.0, 0.0, 0.1] "
                    "}]\n");
              }),
              HasSubstr("is in a region that is held and in one that is moved"));
}

TEST_F(SetupTest, AVertexIsMovedOneWay) {
  const auto moved_by = [&](const char* first, const char* second) {
    return load_of(
        fmt::format("held = [\"bottom\"]\nmoved = [{{ region = \"top\", by = {} }}, "
                    "{{ region = \"ball\", by = {} }}]\n",
                    first, second));
  };
  EXPECT_THAT(test::message_of([&] { moved_by("[0.0, 0.0, 0.001]", "[0.0, 0.0, 0.003]"); }),
              HasSubstr("is in two regions that are moved differently"));
  EXPECT_FALSE(moved_by("[0.0, 0.0, 0.001]", "[0.0, 0.0, 0.001]").holds.empty());
}

TEST_F(SetupTest, MoreMaterialsThanTetrahedraCanTellApartAreRefused) {
  std::string more;
  for (int m = 0; m < 256; ++m) {
    more += fmt::format("[materials.m{}]\nyoung = 1e6\npoisson = 0.4\nregion = \"half\"\n", m);
  }
  const DeformSetup made = setup(std::string(kBlock) + kMaterial + kRegions + more);
  EXPECT_THAT(test::message_of([&] { elasticity_of(made, body_of(made)); }),
              HasSubstr("body.toml: the body has 257 materials; allowed: at most 256"));
}

std::string box_in_obj(const Vector3d& low, const Vector3d& high, int first) {
  std::string text;
  for (int corner = 0; corner < 8; ++corner) {
    text += fmt::format("v {} {} {}\n", corner % 2 == 0 ? low.x() : high.x(),
                        corner / 2 % 2 == 0 ? low.y() : high.y(), corner < 4 ? low.z() : high.z());
  }
  for (const auto& f : {std::array{0, 2, 3, 1},
                        {4, 5, 7, 6},
                        {0, 1, 5, 4},
                        {2, 6, 7, 3},
                        {0, 4, 6, 2},
                        {1, 3, 7, 5}}) {
    text += fmt::format("f {} {} {} {}\n", f[0] + first, f[1] + first, f[2] + first, f[3] + first);
  }
  return text;
}

TEST_F(SetupTest, ACubeThatHangsOnAnEdgeIsLeftOut) {
  write_text(folder_ / "boxes.obj",
             box_in_obj({0, 0, 0}, {4, 4, 4}, 1) + box_in_obj({4, 4, 0}, {5, 5, 1}, 9));
  const auto body = body_of(setup("[body]\nmesh = \"boxes.obj\"\nscale = 0.01\nresolution = 5\n" +
                                  std::string(kMaterial)));
  EXPECT_EQ(body.tetrahedra.size(), 5u * 4 * 4 * 4);
}

TEST_F(SetupTest, TetGensFilesAreRead) {
  write_text(folder_ / "one.node",
             "# a comment\n5 3 0 1\n1 0 0 0 1\n2 1 0 0 1\n3 0 1 0 1\n4 0 0 1 1\n5 9 9 9 0\n");
  write_text(folder_ / "one.ele", "1 4 0\n1 1 3 2 4\n");  // by TetGen's order
  const auto body = read_tetgen(folder_ / "one.node", 2.0);
  ASSERT_EQ(body.vertices.size(), 4u) << "the vertex without a tetrahedron is left out";
  EXPECT_EQ(body.vertices[1], Vector3d(2, 0, 0));
  EXPECT_NO_THROW(check_body(body, "one"));
  write_text(folder_ / "one.ele", "1 4 0\n1 1 2 3 7\n");
  EXPECT_THAT(test::message_of([&] { read_tetgen(folder_ / "one.node", 1.0); }),
              HasSubstr("one.ele:2: there is no vertex 7"));
  write_text(folder_ / "one.ele", "2 4 0\n1 1 2 3 4\n");
  EXPECT_THAT(test::message_of([&] { read_tetgen(folder_ / "one.node", 1.0); }),
              HasSubstr("ends after line 2"));
}

}  // namespace
}  // namespace haptrial::deformable
