#include "core/scene/needed_damping.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/deformable/touch/prepared.h"

namespace haptrial::scene {
namespace {

StiffnessBound of_gains(const control::PdGains& gains) {
  return {true, gains.stiffness, gains.damping};
}

/// @param matrix  symmetric
double largest_eigenvalue(const Eigen::Matrix3d& matrix) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
}

StiffnessBound of_matrix(const MatrixViscousParameters& p) {
  const Eigen::Matrix3d& b = p.matrix;
  const double size = b.cwiseAbs().maxCoeff();
  const double largest = largest_eigenvalue(b + b.transpose());
  const bool symmetric = (b - b.transpose()).cwiseAbs().maxCoeff() <= 1e-12 * size;
  const bool takes = largest <= 1e-12 * size;
  return {takes && (symmetric || std::isinf(p.velocity_filter)), 0.0,
          std::sqrt(largest_eigenvalue(b.transpose() * b))};
}

/// phi(e) with e = depth + h: its second derivative is at most k |g|² along g, and phi' <= limit
/// where h curves. A surface that closes in around the hand adds k at most.
/// @param closes_in  a surface may lie around the hand
StiffnessBound of_surface(const std::vector<Field>& fields, const Field& field,
                          const control::PdGains& gains, bool closes_in) {
  double slope = 0.0;
  double curvature = 0.0;
  for (const Field& other : fields) {
    if (surface_of(other) != field.name) {
      continue;
    }
    const Setting setting{other.limit};
    if (const auto* grating = std::get_if<GratingParameters>(&other.kind)) {
      slope += Grating(*grating, setting).steepest();
      curvature += Grating(*grating, setting).most_curved();
    } else if (const auto* texture = std::get_if<TextureParameters>(&other.kind)) {
      slope += Texture(*texture, setting).steepest();
      curvature += Texture(*texture, setting).most_curved();
    }
  }
  const double lean = (1.0 + slope) * (1.0 + slope);
  const double around = closes_in && slope > 0.0 ? gains.stiffness : 0.0;
  return {true, gains.stiffness * lean + around + field.limit * curvature, gains.damping * lean};
}

StiffnessBound of_surface(const std::vector<Field>& fields, const Field& field,
                          const SurfaceParameters& p) {
  const bool closes_in = p.felt_from_inside && !std::holds_alternative<HalfSpace>(p.shape);
  return of_surface(fields, field, p.gains, closes_in);
}

/// The proxy moves only to come nearer to the tool: the spring between them gives back at most what
/// it was given, and turns against the hand by k at most, also where friction holds the proxy.
/// Shading turns the force away from that way, and renderers without a proxy jump: of them nothing
/// is proven.
StiffnessBound of_rigid_object(const std::vector<Field>& fields, const Field& field,
                               const RigidObjectParameters& p) {
  StiffnessBound found = of_surface(fields, field, p.gains, true);
  found.passive = p.renderer == contact::RendererKind::kProxy && p.crease_angle < 0.0;
  return found;
}

/// The spring between hand and ball and the body behind it, along each other; friction bends a
/// bristle that is no stiffer. Of a body that is not prepared the spring alone is known. What moves
/// keeps an account of its energy, in which the hand has a damping.
StiffnessBound of_deformable_object(const DeformableObjectParameters& p) {
  if (p.springs) {
    return {true, 0.0, deformable::EnergyAccount::kDamping};
  }
  const double body = p.body ? deformable::stiffest_touch(*p.body, p.tool.radius)
                             : std::numeric_limits<double>::infinity();
  const double both = 1.0 / (1.0 / p.tool.stiffness + 1.0 / body);
  return {true, p.tool.friction.static_friction > 0.0 ? 2.0 * both : both, 0.0};
}

struct StiffnessBoundOf {
  const std::vector<Field>& fields;
  const Field& field;

  StiffnessBound operator()(const ConstantParameters&) const { return {true, 0.0, 0.0}; }
  StiffnessBound operator()(const RampParameters&) const { return {}; }
  StiffnessBound operator()(const PulseParameters&) const { return {}; }
  StiffnessBound operator()(const SpringParameters& p) const { return of_gains(p.gains); }
  StiffnessBound operator()(const LineChannelParameters& p) const { return of_gains(p.gains); }
  StiffnessBound operator()(const AxisChannelParameters& p) const { return of_gains(p.gains); }
  StiffnessBound operator()(const PlaneParameters& p) const { return of_gains(p.gains); }
  StiffnessBound operator()(const SurfaceParameters& p) const {
    return of_surface(fields, field, p);
  }
  StiffnessBound operator()(const RigidObjectParameters& p) const {
    return of_rigid_object(fields, field, p);
  }
  StiffnessBound operator()(const DeformableObjectParameters& p) const {
    return of_deformable_object(p);
  }
  StiffnessBound operator()(const GratingParameters&) const { return {true, 0.0, 0.0}; }
  StiffnessBound operator()(const TextureParameters&) const { return {true, 0.0, 0.0}; }
  StiffnessBound operator()(const ViscousParameters& p) const { return {true, 0.0, p.damping}; }
  StiffnessBound operator()(const MatrixViscousParameters& p) const { return of_matrix(p); }
  StiffnessBound operator()(const InertiaParameters&) const { return {}; }
  StiffnessBound operator()(const FrictionParameters& p) const { return {true, p.stiffness, 0.0}; }
  StiffnessBound operator()(const SineVibrationParameters&) const { return {}; }
  StiffnessBound operator()(const NoiseVibrationParameters&) const { return {}; }
  StiffnessBound operator()(const TapParameters&) const { return {}; }
  StiffnessBound operator()(const DetentParameters& p) const {
    return {true, 2.0 * std::numbers::pi * p.peak / p.spacing, 0.0};
  }
  StiffnessBound operator()(const ClickParameters& p) const {
    return {true, p.peak / p.travel, 0.0};
  }
  StiffnessBound operator()(const MoverParameters& p) const {
    return {false, p.gains.stiffness, p.gains.damping};
  }
  StiffnessBound operator()(const PathParameters& p) const {
    return {false, p.gains.stiffness, p.gains.damping};
  }
  StiffnessBound operator()(const RegisteredParameters&) const { return {}; }
};

}  // namespace

StiffnessBound stiffness_bound(const std::vector<Field>& fields, std::size_t which) {
  const Field& field = fields.at(which);
  return std::visit(StiffnessBoundOf{fields, field}, field.kind);
}

double needed_damping(const StiffnessBound& field, double rate) noexcept {
  return 0.5 * field.stiffness / rate + field.damping;
}

double needed_damping_below(double frequency, const StiffnessBound& field, double rate) noexcept {
  return 0.5 * field.stiffness / rate -
         field.damping * std::cos(2.0 * std::numbers::pi * frequency / rate);
}

}  // namespace haptrial::scene
