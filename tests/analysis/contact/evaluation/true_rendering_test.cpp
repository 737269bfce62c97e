// The proxy that is rendered on meshes, beside the truth with friction on the bodies themselves.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "analysis/contact/exam/exam_bodies.h"
#include "analysis/contact/truth/rubbed_profile.h"
#include "analysis/contact/truth/true_contact.h"
#include "core/contact/renderer_kinds.h"
#include "tests/support/truth_cases.h"

namespace haptrial::evaluation::true_rendering_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

constexpr double kRubbed = 0.3;

bool is_curved(const test::TruthCase& one) {
  return std::holds_alternative<TrueSphere>(one.body) ||
         std::holds_alternative<TrueCylinder>(one.body) ||
         std::holds_alternative<TrueTorus>(one.body) ||
         std::holds_alternative<TrueWavyPlate>(one.body);
}

struct Beside {
  double worst{0.0}, square{0.0};  // force error: largest, root mean square [N]
  double mean{0.0};                // of the size of the force [N]
  int touching{0}, alone{0};       // ticks: both touch; only one of the two does
};

Beside beside(const test::TruthCase& one, const Points& tool, int fine, double friction) {
  const geometry::Mesh mesh = mesh_of(one.body, fine);
  const contact::ContactSurface surface(mesh);
  const auto renderer = contact::make_renderer(
      contact::RendererKind::kProxy, mesh, surface,
      {.stiffness = test::kTruthStiffness, .friction = {friction, friction}});
  const auto truth = true_contacts(one.body, tool, test::kTruthStiffness, friction);
  renderer->start(tool.front());
  Beside result;
  for (std::size_t i = 0; i < tool.size(); ++i) {
    const contact::Contact& contact = renderer->tick(tool[i], 1e-3);
    const bool touches = contact.depth > 0.0;
    if (touches != truth[i].touching) {
      ++result.alone;
    } else if (touches) {
      const double error = (contact.force - truth[i].force).norm();
      result.worst = std::max(result.worst, error);
      result.square += error * error;
      result.mean += contact.force.norm() - truth[i].force.norm();
      ++result.touching;
    }
  }
  result.square = std::sqrt(result.square / result.touching);
  result.mean = std::abs(result.mean) / result.touching;
  return result;
}

/// Plane faces are the same on mesh and body: the answer is exact.
TEST(TrueRenderingTest, TheProxyIsExactOnPlaneFaces) {
  for (const test::TruthCase& one : test::truth_cases()) {
    if (is_curved(one)) {
      continue;
    }
    for (const double friction : {0.0, kRubbed}) {
      const Beside b = beside(one, one.there_and_back(), 1, friction);
      EXPECT_LT(b.worst, 1e-9) << one.name << " [N]";
      EXPECT_EQ(b.alone, 0) << one.name;
      EXPECT_GT(b.touching, 1500) << one.name;
    }
  }
}

/// A face has one normal, wrong by up to half of what it turns from its neighbour: the force errs
/// with the first order of the edges, in direction and, as friction does not stand square to the
/// face, in size. Its mean size is better.
TEST(TrueRenderingTest, TheProxyConvergesOnCurvedBodies) {
  for (const test::TruthCase& one : test::truth_cases()) {
    if (!is_curved(one)) {
      continue;
    }
    const Points tool = one.there_and_back();
    const Beside coarse = beside(one, tool, 2, kRubbed), fine = beside(one, tool, 8, kRubbed);
    std::printf("%s: %.4f N with edges four times as long, %.4f N; of the mean size %.5f, %.5f N\n",
                one.name, coarse.square, fine.square, coarse.mean, fine.mean);
    EXPECT_GT(coarse.square / fine.square, 3.4) << one.name;
    EXPECT_LT(fine.mean, 0.1 * fine.square) << one.name;
    EXPECT_LT(fine.square, 0.012) << one.name << " [N], of forces up to 3.7 N";
    EXPECT_LT(fine.alone, 3) << one.name;
    EXPECT_GT(fine.touching, 1500) << one.name;
  }
}

Points rubbed_wedge(const test::TruthCase& wedge, int ticks, double above) {
  Points tool;
  for (int i = 0; i <= ticks; ++i) {
    tool.push_back(wedge.tool(4.0 * i / ticks) + Vector3d(0.0, above, 0.0));
  }
  return tool;
}

/// Over a convex edge that it crosses aslant the proxy leaves the face where the face ends: the
/// length of a tick's step does not matter.
TEST(TrueRenderingTest, AslantOverAnEdgeAPointIsExactAtAnySpeed) {
  const test::TruthCase wedge = test::truth_cases()[4];
  ASSERT_TRUE(std::holds_alternative<TrueWedge>(wedge.body));
  for (const int ticks : {400, 4000, 40000}) {  // steps up to 0.5 mm, 47 and 4.7 micrometres
    for (const double friction : {0.05, kRubbed, 0.8}) {
      const Beside b = beside(wedge, rubbed_wedge(wedge, ticks, 0.0), 1, friction);
      EXPECT_LT(b.worst, 1e-9) << ticks << " ticks, friction " << friction;
      EXPECT_EQ(b.alone, 0);
    }
  }
}

/// Profile of the places of a sphere's centre beside a wedge: outside of two faces and an arc of
/// `facets`.
RubbedProfile rounded_wedge(double flank, double radius, int facets, double friction) {
  const auto at = [&](double a) { return Vector2d(radius * std::sin(a), radius * std::cos(a)); };
  const Vector2d down(std::cos(flank), -std::sin(flank));
  constexpr double kLong = 1e3;  // [m]
  std::vector<ProfileFace> faces{{at(flank), -down, -kLong, 0.0}};
  for (int i = 0; i < facets; ++i) {
    const Vector2d from = at(flank * (1.0 - 2.0 * i / facets));
    const Vector2d way = at(flank * (1.0 - 2.0 * (i + 1) / facets)) - from;
    faces.push_back({from, way.normalized(), 0.0, way.norm()});
  }
  faces.push_back({at(-flank), Vector2d(-down.x(), down.y()), 0.0, kLong});
  return RubbedProfile(faces, false, friction);
}

/// The largest error of the force of a sphere that is rubbed over a wedge [N].
double worst_of_sphere(double radius, int ticks, int facets, double friction) {
  const test::TruthCase wedge = test::truth_cases()[4];
  const auto& body = std::get<TrueWedge>(wedge.body);
  const contact::ContactSurface surface(mesh_of(body, 1));
  contact::Proxy proxy(surface, {.radius = radius, .friction = {friction, friction}});
  RubbedProfile truth = rounded_wedge(body.flank, radius, facets, friction);
  double worst = 0.0;
  const Points tool = rubbed_wedge(wedge, ticks, radius);
  proxy.start(tool.front());
  for (const Vector3d& p : tool) {
    const contact::ProxyState& state = proxy.follow(p);
    const auto there = truth.next(p);
    EXPECT_EQ(there.has_value(), state.state != contact::ContactState::kFree);
    EXPECT_TRUE(state.settled);
    worst = std::max(worst, test::kTruthStiffness * (state.position - there.value_or(p)).norm());
  }
  return worst;
}

/// The truth has an arc of facets: its own error falls with them, the sphere is exact.
TEST(TrueRenderingTest, AslantOverAnEdgeASphereIsExactAtAnySpeed) {
  for (const int ticks : {1000, 10000}) {  // steps up to 0.19 mm and 19 micrometres
    for (const double friction : {0.0, 0.05, kRubbed, 0.8}) {
      SCOPED_TRACE(std::to_string(ticks) + " ticks, friction " + std::to_string(friction));
      // With a depth of 1 mm the sphere hardly rests on the edge.
      EXPECT_LT(worst_of_sphere(0.001, ticks, 4000, friction), 1e-8);
      const double coarse = worst_of_sphere(0.005, ticks, 400, friction);
      const double fine = worst_of_sphere(0.005, ticks, 4000, friction);
      EXPECT_LT(fine, 2e-3);
      EXPECT_LT(fine, 0.2 * coarse);
    }
  }
}

}  // namespace
}  // namespace haptrial::evaluation::true_rendering_test
