#include "core/scene/read/read_rigid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/base/definition/table.h"
#include "core/geometry/mesh/procedural.h"
#include "tests/support/message_of.h"

namespace haptrial::scene::read_solid_test {
namespace {

using testing::HasSubstr;

Field read_thing(const std::string& keys, const contact::SharedBody& body = nullptr) {
  Table document = Table::parse("[objects.thing]\n" + keys + "\n", "x.toml");
  Table objects = document.table("objects");
  Table table = objects.table("thing");
  Field field = read_rigid(table, "thing", body);
  document.finish();
  return field;
}

std::string told_of_thing(const std::string& keys) {
  return test::message_of([&] { read_thing(keys); });
}

const std::string kLeast = "stiffness = 600\ndamping = 1\n";

TEST(ReadRigidTest, EveryKeyIsRead) {
  const Field field = read_thing(kLeast +
                                 "centre = [0.01, 0.02, 0.03]\nturn = [0, 0, 1.5]\nscale = 0.001\n"
                                 "friction = { static = 0.5, dynamic = 0.4 }\nshading = 0.7\n"
                                 "tool_radius = 0.002\nrenderer = \"ruspini\"\nlimit = 5\n"
                                 "fade_in = 0.2\nfade_out = 0.1");
  const auto& p = std::get<RigidObjectParameters>(field.kind);
  EXPECT_EQ(p.pose.position, Eigen::Vector3d(0.01, 0.02, 0.03));
  EXPECT_LT((p.pose.orientation * Eigen::Vector3d::UnitX() -
             Eigen::Vector3d(std::cos(1.5), std::sin(1.5), 0.0))
                .norm(),
            1e-12);
  EXPECT_EQ(p.scale, 0.001);
  EXPECT_EQ(p.gains.stiffness, 600.0);
  EXPECT_EQ(p.friction.static_friction, 0.5);
  EXPECT_EQ(p.friction.dynamic_friction, 0.4);
  EXPECT_EQ(p.crease_angle, 0.7);
  EXPECT_EQ(p.tool_radius, 0.002);
  EXPECT_EQ(p.renderer, contact::RendererKind::kRuspini);
  EXPECT_EQ(field.limit, 5.0);
  EXPECT_EQ(field.fade_in, 0.2);
  EXPECT_EQ(field.fade_out, 0.1);
}

TEST(ReadRigidTest, EveryMistakeGetsItsSentence) {
  EXPECT_THAT(told_of_thing("damping = 1"), HasSubstr("objects.thing.stiffness is missing"));
  EXPECT_THAT(told_of_thing("stiffness = 0\ndamping = 1"), HasSubstr("stiffness is 0"));
  EXPECT_THAT(told_of_thing(kLeast + "scale = 0"), HasSubstr("objects.thing.scale is 0"));
  EXPECT_THAT(told_of_thing(kLeast + "friction = { static = 0.3, dynamic = 0.4 }"),
              HasSubstr("friction.static is 0.3; allowed: at least dynamic, 0.4"));
  EXPECT_THAT(told_of_thing(kLeast + "shading = 2.0"), HasSubstr("objects.thing.shading is 2"));
  EXPECT_THAT(told_of_thing(kLeast + "renderer = \"voxels\""), HasSubstr("renderer is 'voxels'"));
  EXPECT_THAT(told_of_thing(kLeast + "renderer = \"ruspini\""), HasSubstr("add tool_radius"));
  EXPECT_THAT(told_of_thing(kLeast + "renderer = \"penalty\"\ntool_radius = 0.001"),
              HasSubstr("whose tool is a point; leave it out"));
  EXPECT_THAT(told_of_thing(kLeast + "stifness = 5"), HasSubstr("stifness is not a known key"));
}

TEST(ReadRigidTest, KeysOfOtherRenderersAreRefused) {
  const auto cells = read_thing(kLeast + "renderer = \"voxel\"\nresolution = 32");
  EXPECT_EQ(std::get<RigidObjectParameters>(cells.kind).resolution, 32);
  EXPECT_THAT(told_of_thing(kLeast + "resolution = 32"),
              HasSubstr("resolution stands beside the renderer \"proxy\", which has no cells"));
  EXPECT_THAT(told_of_thing(kLeast + "renderer = \"voxel\"\nresolution = 2"),
              HasSubstr("resolution is 2"));
  EXPECT_THAT(
      told_of_thing(kLeast + "renderer = \"penalty\"\nfriction = { static = 0.4, dynamic = 0.3 }"),
      HasSubstr("friction stands beside the renderer \"penalty\", which has none"));
}

TEST(ReadRigidTest, RenderersWithoutAProxyNeedAnInside) {
  geometry::Mesh box = geometry::make_box({0.1, 0.2, 0.3});
  const std::string penalty = kLeast + "renderer = \"penalty\"";
  EXPECT_NO_THROW(read_thing(penalty, contact::felt_body(box)));
  box.triangles.pop_back();
  const contact::SharedBody open = contact::felt_body(box);
  EXPECT_NO_THROW(read_thing(kLeast, open));
  EXPECT_THAT(test::message_of([&] { read_thing(penalty, open); }),
              HasSubstr("renderer is \"penalty\", which needs a closed mesh, and this one is open; "
                        "allowed: proxy, ruspini"));
}

}  // namespace
}  // namespace haptrial::scene::read_solid_test
