#include "analysis/contact/evaluation/check_body.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "core/geometry/mesh/procedural.h"
#include "tests/support/message_of.h"

namespace haptrial::evaluation {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

geometry::Mesh turned(geometry::Mesh mesh) {
  for (geometry::Triangle& t : mesh.triangles) {
    std::swap(t[0], t[1]);
  }
  return mesh;
}

TEST(CheckBodyTest, FacesLookOutwards) {
  const geometry::Mesh box = geometry::make_box({0.1, 0.2, 0.3});
  EXPECT_NO_THROW(check_body(contact::FeltBody(box)));
  EXPECT_THAT(
      test::message_of<std::invalid_argument>([&] { check_body(contact::FeltBody(turned(box))); }),
      HasSubstr("faces look inwards"));
}

TEST(CheckBodyTest, AnOpenMeshIsFeltButSaidToBeOpen) {
  geometry::Mesh box = geometry::make_box({0.1, 0.2, 0.3});
  EXPECT_THAT(body_remarks(contact::FeltBody(box)), IsEmpty());
  box.triangles.pop_back();
  const contact::FeltBody open(turned(box));
  EXPECT_NO_THROW(check_body(open)) << "it has no inside";
  EXPECT_THAT(body_remarks(open), ElementsAre(HasSubstr("not closed")));
}

TEST(CheckBodyTest, APathFitsItsBody) {
  const contact::FeltBody box(geometry::make_box({0.1, 0.2, 0.3}));
  const Eigen::Vector3d middle(1.0, 2.0, 3.0);
  for (const double size : {0.01, 0.1, 0.37}) {
    EXPECT_NO_THROW(
        check_size(box, std::vector{middle, Eigen::Vector3d(middle.array() + size / 2)}));
  }
  for (const double size : {1e-4, 0.6, 370.0}) {
    const std::vector<Eigen::Vector3d> path{middle, {1.0, 2.0, 3.0 + size}};
    EXPECT_THAT(test::message_of<std::invalid_argument>([&] { check_size(box, path); }),
                HasSubstr("--units must be the unit of the mesh"))
        << size;
  }
}

}  // namespace
}  // namespace haptrial::evaluation
