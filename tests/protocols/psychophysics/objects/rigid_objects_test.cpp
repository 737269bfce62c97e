#include "protocols/psychophysics/objects/object_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "core/contact/felt_body.h"
#include "core/geometry/mesh/procedural.h"

namespace haptrial::protocols {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

scene::Field solid(scene::RigidObjectParameters p) {
  p.gains = {5000.0, 2.0};
  scene::Field field;
  field.name = "thing";
  field.kind = std::move(p);
  return field;
}

// Colgate and Schenkel: K T / 2 < b, so 5,000 N/m at 1 kHz ask for 2.5 N·s/m.
TEST(RigidObjectsTest, EachObjectIsSaidToBePassiveOrNotProven) {
  scene::RigidObjectParameters shaded, penalty;
  shaded.crease_angle = 0.5;
  penalty.renderer = contact::RendererKind::kPenalty;
  const scene::Field constant{"pull", scene::ConstantParameters{}};
  const auto lines =
      words_of_rigid_objects({constant, solid({}), solid(shaded), solid(penalty)}, 1000.0, 15.0);
  const auto needs = HasSubstr("2.5 N·s/m of damping at 1000 Hz (K T / 2)");
  const auto unproven = HasSubstr("nothing is proven of it");
  EXPECT_THAT(lines, ElementsAre(AllOf(HasSubstr("objects.thing: at most 5000 N/m; passive"), needs,
                                       HasSubstr("it has 2 itself"),
                                       HasSubstr("the hand of [hand] has 15"), Not(unproven)),
                                 AllOf(needs, unproven, HasSubstr("shading")),
                                 AllOf(needs, unproven, HasSubstr("\"penalty\""))));
}

TEST(RigidObjectsTest, ABodyWhoseFacesLookInwardsIsARoom) {
  geometry::Mesh box = geometry::make_box({0.1, 0.2, 0.3});
  scene::RigidObjectParameters p;
  p.body = contact::felt_body(box);
  EXPECT_THAT(words_of_rigid_objects({solid(p)}, 1000.0, 15.0),
              ElementsAre(Not(HasSubstr("room"))));
  for (geometry::Triangle& t : box.triangles) {
    std::swap(t[0], t[1]);
  }
  p.body = contact::felt_body(box);
  EXPECT_THAT(words_of_rigid_objects({solid(p)}, 1000.0, 15.0),
              ElementsAre(testing::_, HasSubstr("it is a room, free inside and solid around")));
}

}  // namespace
}  // namespace haptrial::protocols
