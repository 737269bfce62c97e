#include "analysis/contact/truth/true_contact.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "tests/support/truth_cases.h"

namespace haptrial::evaluation::true_contact_test {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

/// Down the distance over the parameters of a surface by trying steps in four directions, halved
/// where none helps: no formula of the code under test.
Vector3d descend(const test::Surface& surface, std::array<double, 2>& at, const Vector3d& tool,
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

/// The proxy of every tick lies where a search that begins at the last one ends.
TEST(TrueContactTest, AgreesWithASearchOverTheSurface) {
  for (const test::TruthCase& one : test::truth_cases()) {
    const Points tool = one.path();
    const auto contacts = true_contacts(one.body, tool, test::kTruthStiffness);
    int touching = 0, landings = 0;
    double worst = 0.0;
    std::array<double, 2> place{};
    // The steps are too short to jump over an edge before the tool has passed it.
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
      EXPECT_NEAR(
          (contacts[i].force - test::kTruthStiffness * (contacts[i].proxy - tool[i])).norm(), 0.0,
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
  const auto contacts = true_contacts(TrueThinPlate{0.03, 0.002}, tool, test::kTruthStiffness);
  EXPECT_NEAR((contacts[3].proxy - Vector3d(0.001, 0.001, 0.0)).norm(), 0.0, 1e-15);
  EXPECT_NEAR(contacts[3].force.y(), test::kTruthStiffness * 0.011, 1e-12);
}

/// On a frictionless body a closed path gives back what it took.
TEST(TrueContactTest, AClosedPathNeedsNoWork) {
  for (const test::TruthCase& one : test::truth_cases()) {
    if (std::string(one.name) == "thin plate") {
      continue;  // its tool ends elsewhere
    }
    Points tool{one.tool(0.0)};
    for (int i = 0; i <= 20000; ++i) {  // there and back the same way
      tool.push_back(one.tool(i <= 10000 ? 1e-4 * i : 1e-4 * (20000 - i)));
    }
    const auto contacts = true_contacts(one.body, tool, test::kTruthStiffness);
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

TEST(TrueContactTest, BadArgumentsAreRefused) {
  const Points inside{Vector3d::Zero()}, air{Vector3d(0, 1, 0)};
  EXPECT_THROW(true_contacts(TrueBody{TrueSphere{0.05}}, inside, 1.0), std::invalid_argument);
  EXPECT_THROW(true_contacts(TrueBody{TrueSphere{-1.0}}, air, 1.0), std::invalid_argument);
  EXPECT_THROW(true_contacts(TrueBody{TrueTorus{0.01, 0.02}}, air, 1.0), std::invalid_argument);
  EXPECT_THROW(true_contacts(TruePlane{}, air, 0.0, 0.1), std::invalid_argument);
  EXPECT_THROW(true_contacts(TruePlane{}, air, 1.0, -0.1), std::invalid_argument);
  const Points within{Vector3d(0.04, 0, 0)};
  EXPECT_THROW(true_contacts(TrueTorus{0.04, 0.01}, within, 1.0, 0.1), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::evaluation::true_contact_test
