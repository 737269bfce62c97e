#include "core/deformable/touch/tissue.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "core/base/error.h"

namespace haptrial::deformable {

using Eigen::Vector3d;

namespace {

constexpr int kPointsAlong = 8;  // an edge of a tetrahedron, in which a ball's share is counted
constexpr int kShareSteps = 16;
constexpr std::size_t kTetsOfVoxel = 5;  // one after the other (tetrahedralize.h)

void require_in(const HapticMesh& mesh, double value, bool good, const char* what,
                const char* allowed) {
  if (!good) {
    throw InputError(fmt::format("{}: {} is {:g}; allowed: {}", mesh.name, what, value, allowed));
  }
}

void check_inclusion(const HapticMesh& mesh, const Inclusion& ball) {
  const std::string name = "inclusion " + ball.name;
  require_in(mesh, ball.radius, std::isfinite(ball.radius) && ball.radius >= 0.0,
             (name + ": radius").c_str(), "at least 0 [m]");
  require_in(mesh, ball.young, std::isfinite(ball.young) && ball.young > 0.0,
             (name + ": young").c_str(), "above 0 [Pa]");
  const Eigen::Array3d room = (mesh.box.max() - ball.centre).cwiseMin(ball.centre - mesh.box.min());
  const double rounding = 1e-9 * mesh.spacing;
  if (ball.radius > 0.0 && !(room.minCoeff() >= ball.radius - rounding)) {
    throw InputError(fmt::format(
        "{}: the inclusion {} at ({:g}, {:g}, {:g}) m with a radius of {:g} m does not lie within "
        "the body, which reaches from ({:g}, {:g}, {:g}) to ({:g}, {:g}, {:g}) m",
        mesh.name, ball.name, ball.centre.x(), ball.centre.y(), ball.centre.z(), ball.radius,
        mesh.box.min().x(), mesh.box.min().y(), mesh.box.min().z(), mesh.box.max().x(),
        mesh.box.max().y(), mesh.box.max().z()));
  }
}

/// Counted on n(n+1)(n+2)/6 points, the centres of equal parts of the tetrahedron.
double share_in_ball(const std::array<Vector3d, 4>& p, const Vector3d& centre, double radius) {
  int inside = 0;
  int points = 0;
  constexpr double kUnit = 1.0 / kPointsAlong;
  for (int i = 0; i < kPointsAlong; ++i) {
    for (int j = 0; i + j < kPointsAlong; ++j) {
      for (int k = 0; i + j + k < kPointsAlong; ++k) {
        const double a = (i + 0.25) * kUnit;
        const double b = (j + 0.25) * kUnit;
        const double c = (k + 0.25) * kUnit;
        const Vector3d at = (1.0 - a - b - c) * p[0] + a * p[1] + b * p[2] + c * p[3];
        inside += (at - centre).squaredNorm() <= radius * radius ? 1 : 0;
        ++points;
      }
    }
  }
  return static_cast<double>(inside) / points;
}

double volume_of(const geometry::TetMesh& tets, std::size_t t) {
  const auto corner = [&](std::size_t i) {
    return tets.vertices[static_cast<std::size_t>(tets.tetrahedra[t][i])];
  };
  const Vector3d a = corner(0);
  return (corner(1) - a).dot((corner(2) - a).cross(corner(3) - a)) / 6.0;
}

}  // namespace

void check_tissue(const HapticMesh& mesh, const Tissue& tissue) {
  require_in(mesh, tissue.young, std::isfinite(tissue.young) && tissue.young > 0.0, "young",
             "above 0 [Pa]");
  require_in(mesh, tissue.poisson, tissue.poisson >= 0.0 && tissue.poisson <= kMostPoisson,
             "poisson", "0 to 0.499; at 0.5 a body keeps its volume and no force follows");
  require_in(mesh, tissue.density, std::isfinite(tissue.density) && tissue.density > 0.0, "density",
             "above 0 [kg/m³]");
  require_in(mesh, static_cast<double>(tissue.inclusions.size()),
             tissue.inclusions.size() <= kMostInclusions, "the number of inclusions", "0 to 8");
  for (const Inclusion& ball : tissue.inclusions) {
    check_inclusion(mesh, ball);
  }
}

std::vector<double> shares_in_ball(const HapticMesh& mesh, const Vector3d& centre, double radius) {
  std::vector<double> shares(mesh.tets.tetrahedra.size(), 0.0);
  for (std::size_t t = 0; t < shares.size(); ++t) {
    std::array<Vector3d, 4> corners;
    Eigen::AlignedBox3d box;
    for (std::size_t i = 0; i < 4; ++i) {
      corners[i] = mesh.tets.vertices[static_cast<std::size_t>(mesh.tets.tetrahedra[t][i])];
      box.extend(corners[i]);
    }
    if (box.squaredExteriorDistance(centre) < radius * radius) {
      shares[t] = share_in_ball(corners, centre, radius);
    }
  }
  // The whole voxel counts: its five tetrahedra keep their volume together, as those of one
  // material.
  for (std::size_t first = 0; first + kTetsOfVoxel <= shares.size(); first += kTetsOfVoxel) {
    const std::span own(shares.data() + first, kTetsOfVoxel);
    double sum = 0.0;
    double whole = 0.0;
    for (std::size_t i = 0; i < kTetsOfVoxel; ++i) {
      const double volume = volume_of(mesh.tets, first + i);
      sum += own[i] * volume;
      whole += volume;
    }
    std::ranges::fill(own, sum / whole);
  }
  return shares;
}

Elasticity elasticity_of(const HapticMesh& mesh, const Tissue& tissue) {
  check_tissue(mesh, tissue);
  std::vector<double> log_young(mesh.tets.tetrahedra.size(), std::log(tissue.young));
  for (const Inclusion& ball : tissue.inclusions) {
    const std::vector<double> shares = shares_in_ball(mesh, ball.centre, ball.radius);
    for (std::size_t t = 0; t < shares.size(); ++t) {
      const double share = std::round(kShareSteps * shares[t]) / kShareSteps;
      log_young[t] += share * (std::log(ball.young) - log_young[t]);
    }
  }
  Elasticity elasticity;
  elasticity.law = Law::kLinear;
  elasticity.materials.clear();
  std::map<double, std::uint8_t> known;
  for (const double value : log_young) {
    const auto [at, is_new] =
        known.try_emplace(value, static_cast<std::uint8_t>(elasticity.materials.size()));
    if (is_new && elasticity.materials.size() > 255) {
      throw InputError(fmt::format(
          "{}: its inclusions overlap in too many ways; let them lie apart", mesh.name));
    }
    if (is_new) {
      elasticity.materials.push_back({std::exp(value), tissue.poisson, tissue.density});
    }
    elasticity.material_of.push_back(at->second);
  }
  return elasticity;
}

}  // namespace haptrial::deformable
