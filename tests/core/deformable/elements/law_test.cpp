// The laws by their properties, on a block whose tetrahedra have all sorts of shapes.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "core/deformable/elements/elastic_body.h"
#include "tests/support/jittered_block.h"
#include "tests/support/law_properties.h"

namespace haptrial::deformable {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

Vectors vectors_of(const VectorXd& u) {
  Vectors out;
  for (Eigen::Index i = 0; i < u.size(); i += 3) {
    out.emplace_back(u.segment<3>(i));
  }
  return out;
}

VectorXd stacked(const Vectors& vectors) {
  return Eigen::Map<const VectorXd>(vectors.front().data(),
                                    static_cast<Eigen::Index>(3 * vectors.size()));
}

MatrixXd dense(const BlockMatrix& a) {
  MatrixXd out = MatrixXd::Zero(static_cast<Eigen::Index>(3 * a.rows()),
                                static_cast<Eigen::Index>(3 * a.rows()));
  for (std::size_t row = 0; row < a.rows(); ++row) {
    for (auto at = a.row_start(row); at < a.row_start(row + 1); ++at) {
      const Matrix3d block = Eigen::Map<const Matrix3d>(a.block(at));
      const auto i = static_cast<Eigen::Index>(3 * row);
      out.block<3, 3>(i, 3 * a.column(at)) = block;
      if (i != 3 * a.column(at)) {
        out.block<3, 3>(3 * a.column(at), i) = block.transpose();
      }
    }
  }
  return out;
}

struct Case {
  Law law;
  VolumeForm volume;
  bool mixed;  // two materials, tetrahedra in an order that has no cubes

  friend void PrintTo(const Case& c, std::ostream* out) {
    *out << name_of(c.law) << (c.volume == VolumeForm::kPatches ? " patches" : " tetrahedra")
         << (c.mixed ? " mixed" : "");
  }
};

class LawTest : public testing::TestWithParam<Case> {
 protected:
  static constexpr double kSpacing = 0.01;

  static ElasticBody make_body() {
    geometry::TetMesh mesh = test::jittered_block({2, 1, 2}, kSpacing, 0.1);
    Elasticity elasticity{{{1.5e4, 0.4, 1000}}, {}, GetParam().law, GetParam().volume};
    if (GetParam().mixed) {
      test::shuffle_tetrahedra(mesh);
      elasticity.materials.push_back({1e5, 0.2, 500});
      elasticity.material_of.resize(mesh.tetrahedra.size());
      for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        elasticity.material_of[t] =
            mesh.vertices[static_cast<std::size_t>(mesh.tetrahedra[t][0])].x() > kSpacing;
      }
    }
    return ElasticBody(mesh, elasticity);
  }

  void SetUp() override {
    law_.energy = [this](const VectorXd& u) { return body_.energy(vectors_of(u)); };
    law_.forces = [this](const VectorXd& u) {
      Vectors forces;
      body_.forces(vectors_of(u), forces);
      return stacked(forces);
    };
    law_.stiffness = [this](const VectorXd& u) {
      Vectors forces;
      BlockMatrix matrix(body_.patches().groups(), body_.mesh().vertices.size());
      body_.stiffness(vectors_of(u), forces, matrix);
      return dense(matrix);
    };
    const auto& vertices = body_.mesh().vertices;
    law_.rest = stacked({vertices.begin(), vertices.end()});
    RandomStream random(3, "displacement");
    Matrix3d stretch;
    stretch << 0.2, 0.3, -0.1, 0, -0.15, 0.2, 0.25, 0, 0.1;
    moved_.resize(law_.rest.size());
    for (Eigen::Index i = 0; i < moved_.size(); i += 3) {
      const Vector3d rough(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
      moved_.segment<3>(i) = stretch * law_.rest.segment<3>(i) + 0.2 * kSpacing * rough;
    }
    ASSERT_EQ(body_.inverted(vectors_of(moved_)), -1);
  }

  bool turns_freely() const { return GetParam().law != Law::kLinear; }

  ElasticBody body_ = make_body();
  test::LawUnderTest law_;
  VectorXd moved_;
};

TEST_P(LawTest, ForcesAreMinusTheGradientOfTheEnergy) {
  test::expect_forces_are_gradients(law_, moved_, 1e-5 * kSpacing);
}

TEST_P(LawTest, StiffnessIsTheDerivativeOfTheForces) {
  test::expect_stiffness_is_derivative(law_, moved_, 1e-5 * kSpacing);
}

TEST_P(LawTest, ForcesHaveNoMomentum) { test::expect_momentum(law_, moved_, turns_freely()); }

TEST_P(LawTest, ATurnedBodyPushesTheSameWay) {
  const Vector3d axis = Vector3d(1, -2, 0.5).normalized();
  if (turns_freely()) {
    test::expect_objectivity(law_, moved_, Eigen::AngleAxisd(2.5, axis).toRotationMatrix());
    return;
  }
  // For the linear law: any turn, however large, of a displacement that is taken for small.
  VectorXd turn(law_.rest.size());
  for (Eigen::Index i = 0; i < turn.size(); i += 3) {
    turn.segment<3>(i) = axis.cross(Vector3d(law_.rest.segment<3>(i)));
  }
  const VectorXd forces = law_.forces(moved_);
  EXPECT_LE((law_.forces(moved_ + turn) - forces).norm(), 1e-12 * forces.norm());
}

TEST_P(LawTest, RestHasNoEnergyAndTheStiffnessOfTheLinearLaw) {
  const VectorXd none = VectorXd::Zero(law_.rest.size());
  EXPECT_EQ(law_.energy(none), 0);
  const MatrixXd stiffness = law_.stiffness(none);
  EXPECT_LE(law_.forces(none).norm(), body_.rounding_force());
  Elasticity linear = body_.elasticity();
  linear.law = Law::kLinear;
  const ElasticBody other(body_.mesh(), linear);
  Vectors forces;
  BlockMatrix expected(other.patches().groups(), other.mesh().vertices.size());
  other.stiffness(vectors_of(none), forces, expected);
  EXPECT_LE((stiffness - dense(expected)).norm(), 1e-13 * stiffness.norm());
}

TEST_P(LawTest, StressIsTheEnergysSlopeAlongAnEvenStrain) {
  // One state for all tetrahedra: energy per volume is the stress times the strain that is added.
  Matrix3d stretch;
  stretch << 0.1, 0.2, 0, -0.1, 0.05, 0.1, 0, 0.1, -0.1;
  const auto even = [&](const Matrix3d& g) {
    Vectors u;
    for (const Vector3d& x : body_.mesh().vertices) {
      u.emplace_back(g * x);
    }
    return u;
  };
  Matrix3d direction;
  direction << 0.3, -0.5, 0.2, 0.1, 0.7, -0.4, 0.6, 0.1, 0.2;
  const double step = 1e-6;
  const double slope = (body_.energy(even(stretch + step * direction)) -
                        body_.energy(even(stretch - step * direction))) /
                       (2 * step);
  const std::vector<TetState> states = body_.states(even(stretch));
  double expected = 0;
  for (std::size_t t = 0; t < states.size(); ++t) {
    const auto corner = [&](std::size_t i) {
      return body_.mesh().vertices[static_cast<std::size_t>(body_.mesh().tetrahedra[t][i])];
    };
    const double volume =
        (corner(1) - corner(0)).dot((corner(2) - corner(0)).cross(corner(3) - corner(0))) / 6;
    const Matrix3d& f = states[t].gradient;
    EXPECT_LE((f - Matrix3d::Identity() - stretch).norm(), 1e-13);
    const Matrix3d piola =
        GetParam().law == Law::kLinear
            ? states[t].stress
            : (f.determinant() * states[t].stress * f.inverse().transpose()).eval();
    EXPECT_LE((states[t].stress - states[t].stress.transpose()).norm(),
              1e-12 * states[t].stress.norm());
    expected += volume * (piola.array() * direction.array()).sum();
  }
  EXPECT_NEAR(slope, expected, 1e-7 * std::abs(expected));
}

INSTANTIATE_TEST_SUITE_P(Laws, LawTest,
                         testing::Values(Case{Law::kLinear, VolumeForm::kTetrahedra, false},
                                         Case{Law::kLinear, VolumeForm::kPatches, false},
                                         Case{Law::kCorotational, VolumeForm::kTetrahedra, false},
                                         Case{Law::kCorotational, VolumeForm::kPatches, false},
                                         Case{Law::kNeoHookean, VolumeForm::kTetrahedra, false},
                                         Case{Law::kNeoHookean, VolumeForm::kPatches, false},
                                         Case{Law::kLinear, VolumeForm::kPatches, true},
                                         Case{Law::kCorotational, VolumeForm::kPatches, true},
                                         Case{Law::kNeoHookean, VolumeForm::kPatches, true}));

TEST(ElasticBodyTest, ATurnedInsideOutTetrahedronHasNoForce) {
  const ElasticBody body(test::solid_block({1, 1, 1}, 0.01), {{{1e4, 0.3, 1000}}});
  Vectors u(8, Vector3d::Zero());
  EXPECT_EQ(body.inverted(u), -1);
  u[0] = Vector3d::Constant(0.02);
  EXPECT_GE(body.inverted(u), 0);
  Vectors forces;
  EXPECT_TRUE(std::isinf(body.forces(u, forces)));
}

TEST(ElasticBodyTest, MassesAddUp) {
  const ElasticBody body(test::solid_block({2, 3, 4}, 0.01), {{{1e4, 0.3, 980}}});
  double mass = 0;
  for (const double m : body.masses()) {
    mass += m;
  }
  EXPECT_NEAR(mass, 980 * 24e-6, 1e-15);
}

}  // namespace
}  // namespace haptrial::deformable
