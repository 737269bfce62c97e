#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <string>

#include "analysis/contact/truth/rubbed_profile.h"
#include "analysis/contact/truth/true_contact.h"
#include "tests/support/truth_cases.h"

namespace haptrial::evaluation::true_friction_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

constexpr double kFriction = 0.3;

/// The pull on a point of a surface along the surface, from differences of places and distances.
struct Pull {
  Vector2d way;        // of the parameters for a metre of length
  double along, push;  // of the tool's distance: along the surface, and the rest [m]
};

constexpr double kDifference = 1e-6;
constexpr double kNoise = 1e-10;  // of such a pull [m]

Pull pull_at(const test::Surface& surface, const Vector2d& at, const Vector3d& tool) {
  Eigen::Matrix<double, 3, 2> tangents;
  Vector2d downhill;
  for (int k = 0; k < 2; ++k) {
    const Vector2d step = kDifference * Vector2d::Unit(k);
    const Vector3d more = surface(at[0] + step[0], at[1] + step[1]);
    const Vector3d less = surface(at[0] - step[0], at[1] - step[1]);
    tangents.col(k) = (more - less) / (2.0 * kDifference);
    downhill[k] = ((less - tool).squaredNorm() - (more - tool).squaredNorm()) / (4.0 * kDifference);
  }
  const Vector2d way = (tangents.transpose() * tangents).inverse() * downhill;
  const double along = (tangents * way).norm();
  const double square = (surface(at[0], at[1]) - tool).squaredNorm() - along * along;
  return {along > 0.0 ? Vector2d(way / along) : way, along, std::sqrt(std::max(square, 0.0))};
}

/// Slides down the distance in steps of a micrometre until the cone holds it: knows neither a
/// normal nor a formula.
Vector3d creep(const test::Surface& surface, Vector2d at, const Vector3d& tool, double friction) {
  constexpr double kStep = 1e-6;  // [m]
  const auto held = [&](const Vector2d& there) {
    const Pull pull = pull_at(surface, there, tool);
    return pull.along <= friction * pull.push * (1.0 + 1e-9);
  };
  while (!held(at)) {
    const Vector2d way = pull_at(surface, at, tool).way;
    double step = kStep;
    if (held(at + step * way)) {
      double low = 0.0;
      for (int i = 0; i < 30; ++i) {
        (held(at + 0.5 * (low + step) * way) ? step : low) = 0.5 * (low + step);
      }
    }
    at += step * way;
  }
  return surface(at[0], at[1]);
}

/// In a valley both faces push, which differences over it do not tell.
bool in_valley(const test::TruthCase& one, const Vector3d& proxy) {
  return std::holds_alternative<TrueConcaveEdge>(one.body) && std::abs(proxy.x()) < 1e-5;
}
bool on_edge(const test::TruthCase& one, const Vector3d& p) {
  const double near = 2.0 * kDifference;
  return (std::holds_alternative<TrueWedge>(one.body) && std::abs(p.x()) < near) ||
         (std::holds_alternative<TrueThinPlate>(one.body) && std::abs(p.x()) > 0.015 - near &&
          std::abs(p.y()) > 0.001 - near);
}

class TrueFrictionTest : public testing::TestWithParam<std::size_t> {
 protected:
  const test::TruthCase one_{test::truth_cases()[GetParam()]};
};

TEST_P(TrueFrictionTest, AgreesWithASearchOverTheSurface) {
  const Points tool = one_.there_and_back();
  const auto contacts = true_contacts(one_.body, tool, test::kTruthStiffness, kFriction);
  int stuck = 0, slid = 0, valley = 0;
  double worst = 0.0;
  for (std::size_t i = 1; i < tool.size(); ++i) {
    const Vector3d& p = contacts[i].proxy;
    const Vector3d& before = contacts[i - 1].proxy;
    if (!contacts[i].touching || !contacts[i - 1].touching) {
      continue;
    }
    if (in_valley(one_, p) || in_valley(one_, before) || on_edge(one_, p)) {
      ++valley;
      continue;
    }
    const auto place = one_.place(before), now = one_.place(p);
    const Pull pull = pull_at(one_.surface, {now[0], now[1]}, tool[i]);
    EXPECT_LE(pull.along, kFriction * pull.push + kNoise) << i;
    const bool same = (p - before).norm() < 1e-14;
    (same ? stuck : slid) += 1;
    if (!same) {
      EXPECT_NEAR(pull.along, kFriction * pull.push, kNoise) << i;
    }
    const Vector3d crept = creep(one_.surface, {place[0], place[1]}, tool[i], kFriction);
    worst = std::max(worst, (crept - p).norm());
  }
  std::printf("%s: worst %.2e m, stuck %d, slid %d, valley %d\n", one_.name, worst, stuck, slid,
              valley);
  EXPECT_LT(worst, 2e-8) << "[m]; the search's own steps are 1e-6 m long";
  EXPECT_LT(valley, 1500);
  EXPECT_GT(stuck, 20);
  EXPECT_GT(slid, 400);
}

TEST_P(TrueFrictionTest, WithoutFrictionItIsTheFrictionlessTruth) {
  const Points tool = one_.there_and_back();
  const auto smooth = true_contacts(one_.body, tool, test::kTruthStiffness);
  const auto rubbed = true_contacts(one_.body, tool, test::kTruthStiffness, 0.0);
  double worst = 0.0;
  for (std::size_t i = 0; i < tool.size(); ++i) {
    EXPECT_EQ(smooth[i].touching, rubbed[i].touching) << i;
    worst = std::max(worst, (smooth[i].force - rubbed[i].force).norm());
  }
  EXPECT_LT(worst, 1e-9) << "[N]";
}

INSTANTIATE_TEST_SUITE_P(Bodies, TrueFrictionTest, testing::Range<std::size_t>(0, 8),
                         [](const auto& which) {
                           std::string name = test::truth_cases()[which.param].name;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

/// A tool that goes round at an even depth, behind a surface of radius R about the origin, drags
/// the proxy behind by an angle at which the force lies on the cone. `inner`: the solid is outside.
void check_lag(const TrueBody& body, double radius, bool inner, const Vector3d& centre,
               const Vector3d& x, const Vector3d& y) {
  const double depth = 0.002, r = inner ? radius + depth : radius - depth;
  const double free = inner ? radius - depth : radius + depth;
  Points tool{centre + free * x};
  for (int i = 0; i <= 400; ++i) {
    const double a = 5e-3 * i;
    tool.push_back(centre + r * (std::cos(a) * x + std::sin(a) * y));
  }
  const TrueContact last = true_contacts(body, tool, test::kTruthStiffness, kFriction).back();
  const Vector3d p = last.proxy - centre, t = tool.back() - centre;
  EXPECT_NEAR(p.norm(), radius, 1e-12);
  EXPECT_NEAR(p.dot(x.cross(y)), 0.0, 1e-12) << "within the circle's plane";
  const double lag = std::atan2(p.cross(t).dot(x.cross(y)), p.dot(t));
  const double height = radius - r * std::cos(lag);
  EXPECT_NEAR(r * std::sin(lag), kFriction * (inner ? -height : height), 1e-12);
  EXPECT_GT(lag, 0.001);
}

TEST(TrueFrictionTest, OnACircleTheProxyLagsByTheConesAngle) {
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  const Vector3d none = Vector3d::Zero();
  check_lag(TrueSphere{0.05}, 0.05, false, none, x, y);
  check_lag(TrueSphere{0.05}, 0.05, false, none, (x + z).normalized(), y);
  check_lag(TrueCylinder{0.03}, 0.03, false, none, x, y);
  const TrueTorus torus{0.04, 0.015};
  check_lag(torus, 0.015, false, 0.04 * x, x, z);   // round the tube
  check_lag(torus, 0.015, false, 0.04 * y, -z, y);  // and over its inner side
  check_lag(torus, 0.055, false, none, x, y);       // round the outside
  check_lag(torus, 0.025, true, none, x, y);        // round the hole
}

/// Pulled along an inclined way a cylinder's proxy lags straight behind once the way is long.
TEST(TrueFrictionTest, AlongACylinderItLagsByTheConesAngle) {
  const double depth = 0.002;
  Points tool{{0.032, 0.0, 0.0}};
  for (int i = 0; i <= 2000; ++i) {
    tool.emplace_back(0.03 - depth, 0.0, 1e-5 * i);
  }
  const TrueContact last =
      true_contacts(TrueCylinder{0.03}, tool, test::kTruthStiffness, kFriction).back();
  EXPECT_NEAR((last.proxy - Vector3d(0.03, 0.0, 0.02 - kFriction * depth)).norm(), 0.0, 1e-12);
}

TEST(TrueFrictionTest, AValleyHoldsByTheSumOfItsFaces) {
  const double flank = 0.6, depth = 0.002;
  Points tool{{0.0, 0.001, 0.0}};
  for (int i = 0; i <= 1000; ++i) {
    tool.emplace_back(0.0, -depth, 1e-5 * i);
  }
  const auto contacts =
      true_contacts(TrueConcaveEdge{flank}, tool, test::kTruthStiffness, kFriction);
  for (std::size_t i = 1; i < contacts.size(); ++i) {
    const double most = kFriction * test::kTruthStiffness * depth / std::cos(flank);
    const Vector3d& f = contacts[i].force;
    EXPECT_NEAR(f.x(), 0.0, 1e-12);
    EXPECT_NEAR(f.y(), test::kTruthStiffness * depth, 1e-12);
    EXPECT_NEAR(f.z(), -std::min(test::kTruthStiffness * tool[i].z(), most), 1e-10);
  }
}

TEST(TrueFrictionTest, AThinPlateHoldsAToolThatWentThroughAndLetsItGoOverTheRim) {
  const Points tool{{0.0, 0.002, 0.0},
                    {0.0, -0.01, 0.0},
                    {0.003, -0.01, 0.0},
                    {0.01, -0.01, 0.0},
                    {0.02, -0.01, 0.0}};
  const auto contacts =
      true_contacts(TrueThinPlate{0.03, 0.002}, tool, test::kTruthStiffness, kFriction);
  EXPECT_NEAR((contacts[2].proxy - Vector3d(0.0, 0.001, 0.0)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((contacts[3].proxy - Vector3d(0.0067, 0.001, 0.0)).norm(), 0.0, 1e-15);
  EXPECT_TRUE(contacts[3].touching);
  EXPECT_FALSE(contacts[4].touching);
}

/// A plane without a closed form.
class SteppedPlane final : public SmoothSurface {
 public:
  double height(const Vector3d& p) const override { return p.y(); }
  Vector3d onto(const Vector3d& p) const override { return {p.x(), 0.0, p.z()}; }
  Vector3d normal(const Vector3d&) const override { return Vector3d::UnitY(); }
};

/// A body with a closed form that does not use it.
class Stepped final : public SmoothSurface {
 public:
  explicit Stepped(std::unique_ptr<SmoothSurface> of) : of_(std::move(of)) {}
  double height(const Vector3d& p) const override { return of_->height(p); }
  Vector3d onto(const Vector3d& p) const override { return of_->onto(p); }
  Vector3d normal(const Vector3d& on) const override { return of_->normal(on); }

 private:
  std::unique_ptr<SmoothSurface> of_;
};

/// The closed forms of plane and sphere, in which the proxy goes straight or along a great circle,
/// and the cylinder's sliding way, a curve of its own.
TEST(TrueFrictionTest, TheIntegratorReproducesTheClosedForms) {
  const auto cases = test::truth_cases();
  for (const std::size_t which : {0u, 1u, 2u}) {
    const test::TruthCase& one = cases[which];
    for (const double friction : {0.0, 0.1, 0.5}) {
      std::unique_ptr<SmoothSurface> surface = std::make_unique<SteppedPlane>();
      if (const auto* sphere = std::get_if<TrueSphere>(&one.body)) {
        surface = std::make_unique<Stepped>(smooth_surface(*sphere));
      } else if (const auto* cylinder = std::get_if<TrueCylinder>(&one.body)) {
        surface = std::make_unique<Stepped>(smooth_surface(*cylinder));
      }
      RubbedSurface stepped(std::move(surface), friction);
      Points tool;  // few and large steps: long ways of sliding
      for (int i = 0; i <= 100; ++i) {
        tool.push_back(one.tool(0.04 * i));
      }
      const auto exact = true_contacts(one.body, tool, test::kTruthStiffness, friction);
      double worst = 0.0;
      for (std::size_t i = 0; i < tool.size(); ++i) {
        const auto at = stepped.next(tool[i]);
        ASSERT_EQ(at.has_value(), exact[i].touching) << one.name << " " << i;
        worst = std::max(worst, at ? (*at - exact[i].proxy).norm() : 0.0);
      }
      std::printf("%s, friction %.1f: worst %.2e m\n", one.name, friction, worst);
      EXPECT_LT(worst, 1e-9) << one.name << ", friction " << friction;
    }
  }
}

}  // namespace
}  // namespace haptrial::evaluation::true_friction_test
