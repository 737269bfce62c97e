#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <utility>
#include <vector>

#include "analysis/contact/evaluation/check_body.h"
#include "analysis/contact/evaluation/render_contact.h"
#include "core/geometry/mesh/procedural.h"
#include "tests/support/message_of.h"

namespace haptrial::evaluation {
namespace {

using contact::RendererKind;
using Eigen::Vector3d;

/// A hand that presses 1 N on a plate of 1 mm: over 100 N/m the in-trajectory lies 9 mm behind it.
TEST(RenderContactTest, AContactThatIsNotFeltIsOffByItsDepth) {
  const contact::FeltBody plate(geometry::make_box({0.1, 0.001, 0.1}));
  PreparedContact contact;
  contact.rate = 1000.0;
  contact.stiffness = 100.0;
  for (int i = 0; i < 50; ++i) {
    const Vector3d on(1e-4 * i, 0.0005, 0.0);
    contact.touching.push_back(true);
    contact.out.push_back(on);
    contact.in.emplace_back(on - Vector3d(0.0, 0.01, 0.0));
    contact.normal.push_back(Vector3d::UnitY());
    contact.force.push_back(Vector3d::UnitY());
  }
  const RenderedContact felt = render_contact(contact, plate, RendererKind::kProxy, {});
  EXPECT_EQ(felt.lost, 0u);
  EXPECT_NEAR(position_error(contact.out, felt.place, 0.001).worst, 0.0, 1e-12);
  const RenderedContact lost = render_contact(contact, plate, RendererKind::kPenalty, {});
  EXPECT_EQ(lost.lost, contact.in.size());
  EXPECT_NEAR(position_error(contact.out, lost.place, 0.001).mean_norm, 0.01, 1e-12);
}

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
