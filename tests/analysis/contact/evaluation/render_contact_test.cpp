#include "analysis/contact/evaluation/render_contact.h"

#include <gtest/gtest.h>

#include "core/geometry/mesh/procedural.h"

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

}  // namespace
}  // namespace haptrial::evaluation
