#include "analysis/contact/truth/true_contact.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

namespace haptrial::evaluation {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;
using Surface = std::function<Vector3d(double, double)>;

constexpr double kStiffness = 500.0;

/// Down the distance over the parameters of a surface by trying steps in four directions, halved
/// where none helps: no formula of the code under test.
Vector3d descend(const Surface& surface, std::array<double, 2>& at, const Vector3d& tool,
                 double step) {
  double best = (surface(at[0], at[1]) - tool).squaredNorm();
  while (step > 1e-10) {
    bool moved = false;
    for (int way = 0; way < 4; ++way) {
      std::array<double, 2> next = at;
      next[static_cast<std::size_t>(way / 2)] += way % 2 == 0 ? step : -step;
      const double distance = (surface(next[0], next[1]) - tool).squaredNorm();
      if (distance < best) {
        best = distance;
        at = next;
        moved = true;
      }
    }
    step *= moved ? 1.0 : 0.5;
  }
  return surface(at[0], at[1]);
}

struct TruthCase {
  const char* name;
  TrueBody body;
  Surface surface;                                              // by two parameters, lengths [m]
  std::function<std::array<double, 2>(const Vector3d&)> place;  // of a point on it
  std::function<Vector3d(double)> tool;                         // t from 0, in the air there
};

double sway(double t) { return 0.02 * std::sin(2.3 * t); }
double dip(double t) { return 0.004 * std::cos(5.0 * t) - 0.0035 * (1.0 - std::exp(-t)); }

std::vector<TruthCase> cases() {
  const double flank = 0.6, pi = std::numbers::pi;
  const double c = std::cos(flank), s = std::sin(flank);
  const auto by_x = [](const Vector3d& p) { return std::array{p.x(), p.z()}; };
  return {
      {"plane", TruePlane{}, [](double u, double v) { return Vector3d(u, 0.0, v); }, by_x,
       [](double t) { return Vector3d(sway(t), dip(t), 0.3 * sway(2.0 * t)); }},
      {"sphere", TrueSphere{0.05},
       [](double u, double v) {
         return Vector3d(0.05 * std::cos(v) * std::cos(u), 0.05 * std::cos(v) * std::sin(u),
                         0.05 * std::sin(v));
       },
       [](const Vector3d& p) {
         return std::array{std::atan2(p.y(), p.x()), std::asin(p.z() / 0.05)};
       },
       [](double t) {
         const double a = 0.4 + sway(t) / 0.02, b = 0.6 * std::sin(t);
         return Vector3d((0.05 + dip(t)) * Vector3d(std::cos(b) * std::cos(a),
                                                    std::cos(b) * std::sin(a), std::sin(b)));
       }},
      {"cylinder", TrueCylinder{0.03},
       [](double u, double v) { return Vector3d(0.03 * std::cos(u), 0.03 * std::sin(u), v); },
       [](const Vector3d& p) {
         return std::array{std::atan2(p.y(), p.x()), p.z()};
       },
       [](double t) {
         const double a = sway(t) / 0.02;
         return Vector3d((0.03 + dip(t)) * std::cos(a), (0.03 + dip(t)) * std::sin(a),
                         sway(1.7 * t));
       }},
      {"torus", TrueTorus{0.04, 0.015},
       [](double u, double v) {
         const double out = 0.04 + 0.015 * std::cos(v);
         return Vector3d(out * std::cos(u), out * std::sin(u), 0.015 * std::sin(v));
       },
       [](const Vector3d& p) {
         return std::array{std::atan2(p.y(), p.x()), std::atan2(p.z(), p.head<2>().norm() - 0.04)};
       },
       [](double t) {
         const double a = sway(t) / 0.02, b = 2.0 * std::sin(0.9 * t), r = 0.015 + dip(t);
         const double out = 0.04 + r * std::cos(b);
         return Vector3d(out * std::cos(a), out * std::sin(a), r * std::sin(b));
       }},
      {"wedge", TrueWedge{flank},
       [c, s](double u, double v) { return Vector3d(c * u, -s * std::abs(u), v); },
       [c](const Vector3d& p) {
         return std::array{p.x() / c, p.z()};
       },
       [](double t) {
         const double x = 0.4 * sway(t);
         return Vector3d(x, -0.684 * std::abs(x) + dip(t), sway(0.7 * t));
       }},
      {"concave edge", TrueConcaveEdge{flank},
       [c, s](double u, double v) { return Vector3d(c * u, s * std::abs(u), v); },
       [c](const Vector3d& p) {
         return std::array{p.x() / c, p.z()};
       },
       [](double t) {
         const double x = 0.4 * sway(t);
         return Vector3d(x, 0.684 * std::abs(x) + dip(t), sway(0.7 * t));
       }},
      {"wavy plate", TrueWavyPlate{0.001, 0.02},
       [pi](double u, double v) { return Vector3d(u, 0.001 * std::sin(2.0 * pi * u / 0.02), v); },
       by_x, [](double t) { return Vector3d(sway(t), 0.4 * dip(t) + 0.0006, sway(0.7 * t)); }},
      {"thin plate", TrueThinPlate{0.03, 0.002},
       [](double u, double v) {  // round the rim: the upper side, the side at +x, the lower one
         const double x = std::min(u, 0.015), y = std::clamp(0.001 - (u - 0.015), -0.001, 0.001);
         return u < 0.017 ? Vector3d(x, y, v) : Vector3d(0.015 - (u - 0.017), -0.001, v);
       },
       [](const Vector3d& p) {
         return std::array{p.x() < 0.015     ? (p.y() > 0.0 ? p.x() : 0.032 - p.x())
                           : p.y() <= -0.001 ? 0.017
                                             : 0.016 - p.y(),
                           p.z()};
       },
       // Presses through the plate to below it, then drags the proxy round the rim.
       [](double t) {
         return Vector3d(0.005 + 0.0034 * t, 0.002 - 0.003 * std::min(t, 1.5), 0.002 * t);
       }}};
}

/// The proxy of every tick lies where a search that begins at the last one ends.
TEST(TrueContactTest, AgreesWithASearchOverTheSurface) {
  for (const TruthCase& one : cases()) {
    Points tool;
    for (int i = 0; i <= 4000; ++i) {
      tool.push_back(one.tool(1e-3 * i));
    }
    const auto contacts = true_contacts(one.body, tool, kStiffness);
    int touching = 0, landings = 0;
    double worst = 0.0;
    std::array<double, 2> place{};
    // Too short to jump over an edge before the tool has passed it.
    const bool edge = std::holds_alternative<TrueWedge>(one.body) ||
                      std::holds_alternative<TrueThinPlate>(one.body);
    const double step = edge ? 1e-7 : 1e-5;
    for (std::size_t i = 0; i < tool.size(); ++i) {
      if (!contacts[i].touching) {
        EXPECT_EQ(contacts[i].force.norm(), 0.0);
        continue;
      }
      ++touching;
      if (!contacts[i - 1].touching) {
        place = one.place(contacts[i].proxy);  // then the search goes alone
        ++landings;
      }
      worst =
          std::max(worst, (descend(one.surface, place, tool[i], step) - contacts[i].proxy).norm());
      EXPECT_NEAR((contacts[i].force - kStiffness * (contacts[i].proxy - tool[i])).norm(), 0.0,
                  1e-12);
    }
    RecordProperty(std::string(one.name) + " worst_nm", static_cast<int>(1e9 * worst));
    EXPECT_LT(worst, 1e-7) << one.name;  // the search's own step of 1e-10 on lengths near 1e-2
    EXPECT_GT(touching, 500) << one.name;
    EXPECT_GE(landings, 1) << one.name;
  }
}

TEST(TrueContactTest, AThinPlateHoldsAToolThatWentThrough) {
  const Points tool{{0, 0.002, 0}, {0, 0.0005, 0}, {0, -0.003, 0}, {0.001, -0.01, 0}};
  const auto contacts = true_contacts(TrueThinPlate{0.03, 0.002}, tool, kStiffness);
  EXPECT_NEAR((contacts[3].proxy - Vector3d(0.001, 0.001, 0.0)).norm(), 0.0, 1e-15);
  EXPECT_NEAR(contacts[3].force.y(), kStiffness * 0.011, 1e-12);
}

/// On a frictionless body a closed path gives back what it took.
TEST(TrueContactTest, AClosedPathNeedsNoWork) {
  for (const TruthCase& one : cases()) {
    if (std::string(one.name) == "thin plate") {
      continue;  // its tool ends elsewhere
    }
    Points tool{one.tool(0.0)};
    for (int i = 0; i <= 20000; ++i) {  // there and back the same way
      tool.push_back(one.tool(i <= 10000 ? 1e-4 * i : 1e-4 * (20000 - i)));
    }
    const auto contacts = true_contacts(one.body, tool, kStiffness);
    double work = 0.0, moved = 0.0;
    for (std::size_t i = 1; i < tool.size(); ++i) {
      const double part =
          0.5 * (contacts[i].force + contacts[i - 1].force).dot(tool[i] - tool[i - 1]);
      work += part;
      moved += std::abs(part);
    }
    EXPECT_LT(std::abs(work), 1e-4 * moved) << one.name;
  }
}

Points rubbing_path(bool round) {
  Points tool;
  for (int i = 0; i <= 4000; ++i) {
    const double t = 1e-3 * i, a = 0.5 * std::sin(3.1 * t), b = 0.4 * std::sin(3.1 * t);
    const Vector3d way(std::sin(a), std::cos(a) * std::cos(b), std::sin(b));
    tool.push_back(round ? Vector3d((0.05 + dip(t)) * way.normalized())
                         : Vector3d(0.05 * a, dip(t), 0.05 * b));
  }
  return tool;
}

/// Slides in steps of a micrometre along the force's tangential part until the cone holds it.
Vector3d creep(Vector3d proxy, const Vector3d& tool, double friction,
               const std::function<Vector3d(const Vector3d&)>& onto,
               const std::function<Vector3d(const Vector3d&)>& normal) {
  for (;;) {
    const Vector3d n = normal(proxy), pull = tool - proxy;
    const Vector3d along = pull - pull.dot(n) * n;
    if (along.norm() <= friction * -pull.dot(n)) {
      return proxy;
    }
    proxy = onto(proxy + std::min(1e-6, along.norm()) * along.normalized());
  }
}

void check_friction(const Points& tool, const std::vector<TrueContact>& contacts, double friction,
                    const std::function<Vector3d(const Vector3d&)>& onto,
                    const std::function<Vector3d(const Vector3d&)>& normal) {
  int stuck = 0, slid = 0;
  for (std::size_t i = 1; i < tool.size(); ++i) {
    if (!contacts[i].touching || !contacts[i - 1].touching) {
      continue;
    }
    const Vector3d n = normal(contacts[i].proxy);
    const double push = contacts[i].force.dot(n);
    const double rub = (contacts[i].force - push * n).norm();
    EXPECT_LE(rub, friction * push + 1e-9);
    const Vector3d crept = creep(contacts[i - 1].proxy, tool[i], friction, onto, normal);
    EXPECT_LT((crept - contacts[i].proxy).norm(), 2e-6);
    const bool same = (contacts[i].proxy - contacts[i - 1].proxy).norm() < 1e-14;
    (same ? stuck : slid) += 1;
    if (!same) {
      EXPECT_NEAR(rub, friction * push, 1e-9);
    }
  }
  EXPECT_GT(stuck, 20);
  EXPECT_GT(slid, 500);
}

TEST(TrueContactTest, FrictionOnAPlaneHoldsTheLawOfCoulomb) {
  const Points tool = rubbing_path(false);
  check_friction(
      tool, true_contacts(TruePlane{}, tool, kStiffness, 0.4), 0.4,
      [](const Vector3d& p) { return Vector3d(p.x(), 0.0, p.z()); },
      [](const Vector3d&) { return Vector3d::UnitY(); });
}

TEST(TrueContactTest, FrictionOnASphereHoldsTheLawOfCoulomb) {
  const Points tool = rubbing_path(true);
  check_friction(
      tool, true_contacts(TrueSphere{0.05}, tool, kStiffness, 0.4), 0.4,
      [](const Vector3d& p) { return Vector3d(0.05 * p.normalized()); },
      [](const Vector3d& p) { return Vector3d(p.normalized()); });
}

TEST(TrueContactTest, WithoutFrictionBothFormsAgree) {
  const Points tool = rubbing_path(true);
  const auto smooth = true_contacts(TrueBody{TrueSphere{0.05}}, tool, kStiffness);
  const auto rubbed = true_contacts(TrueSphere{0.05}, tool, kStiffness, 0.0);
  for (std::size_t i = 0; i < tool.size(); ++i) {
    EXPECT_NEAR((smooth[i].force - rubbed[i].force).norm(), 0.0, 1e-9);
  }
}

TEST(TrueContactTest, BadArgumentsAreRefused) {
  const Points inside{Vector3d::Zero()}, air{Vector3d(0, 1, 0)};
  EXPECT_THROW(true_contacts(TrueBody{TrueSphere{0.05}}, inside, 1.0), std::invalid_argument);
  EXPECT_THROW(true_contacts(TrueBody{TrueSphere{-1.0}}, air, 1.0), std::invalid_argument);
  EXPECT_THROW(true_contacts(TrueBody{TrueTorus{0.01, 0.02}}, air, 1.0), std::invalid_argument);
  EXPECT_THROW(true_contacts(TruePlane{}, air, 0.0, 0.1), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::evaluation
