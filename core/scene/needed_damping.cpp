#include "core/scene/needed_damping.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptrial::scene {

ReliefBound reliefs_on(const std::vector<Field>& fields, const Field& surface) {
  ReliefBound sum;
  for (const Field& field : fields) {
    if (surface_of(field) != surface.name) {
      continue;
    }
    std::visit(
        [&](const auto& p) {
          if constexpr (requires { p.relief_bound(); }) {
            const ReliefBound own = p.relief_bound();
            sum.slope += own.slope;
            sum.curvature += own.curvature;
            sum.usual_slope += own.usual_slope;
            sum.usual_curvature += own.usual_curvature;
          }
        },
        field.kind);
  }
  return sum;
}

/// A surface stores phi(e) with e = depth + h: its second derivative is at most k |g|² along g, and
/// phi' <= limit if h curves. A surface that closes in around the hand adds k at most.
StiffnessBound stiffness_bound(const std::vector<Field>& fields, std::size_t which) {
  const Field& field = fields.at(which);
  StiffnessBound bound = std::visit([](const auto& p) { return p.bound(); }, field.kind);
  const FieldTraits traits = traits_of(field);
  if (!traits.surface) {
    return bound;
  }
  const ReliefBound reliefs = reliefs_on(fields, field);
  const double lean = (1.0 + reliefs.slope) * (1.0 + reliefs.slope);
  const double around = traits.closes_in && reliefs.slope > 0.0 ? bound.stiffness : 0.0;
  bound.stiffness = bound.stiffness * lean + around + field.limit * reliefs.curvature;
  bound.damping *= lean;
  return bound;
}

double needed_damping(const StiffnessBound& field, double rate) noexcept {
  return 0.5 * field.stiffness / rate + field.damping + std::max(field.driving, 0.0);
}

double needed_damping_below(double frequency, const StiffnessBound& field, double rate) noexcept {
  const double damper = -field.damping * std::cos(2.0 * std::numbers::pi * frequency / rate);
  return 0.5 * field.stiffness / rate +
         (field.driving > 0.0 ? std::max(field.driving, damper) : damper);
}

}  // namespace haptrial::scene
