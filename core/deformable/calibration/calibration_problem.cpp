#include "core/deformable/calibration/calibration_problem.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/deformable/springs/equilibrium.h"
#include "core/deformable/springs/spring_tangent.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;
using Positions = std::vector<Vector3d>;

constexpr int kIterations = 60;  // of Newton's method: what rests takes fewer than 30

void check_reference(const SpringBody& body, const CalibrationLoad& load) {
  if (load.reference.size() != body.rest.size()) {
    throw InputError(fmt::format("load '{}': the reference has {} vertices; the body has {}",
                                 load.load.name, load.reference.size(), body.rest.size()));
  }
  if (!std::all_of(load.reference.begin(), load.reference.end(),
                   [](const Vector3d& p) { return p.allFinite(); })) {
    throw InputError(fmt::format("load '{}': the reference is not finite", load.load.name));
  }
}

/// -λ · (force of each spring with the constant 1), as what the spring's energy gradient is.
template <std::size_t n, class Forces>
std::vector<double> along(const std::vector<std::array<std::int32_t, n>>& springs,
                          const std::vector<double>& rest, const Positions& positions,
                          const Positions& direction, Forces forces) {
  std::vector<double> result;
  result.reserve(springs.size());
  for (std::size_t s = 0; s < springs.size(); ++s) {
    const auto force = forces(Spring{1.0, rest[s]}, points_of<n>(positions, springs[s]));
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      sum += force[i].dot(direction[static_cast<std::size_t>(springs[s][i])]);
    }
    result.push_back(sum);
  }
  return result;
}

void add_to(std::vector<double>& sum, const std::vector<double>& more, double scale) {
  sum.resize(more.size(), 0.0);
  for (std::size_t i = 0; i < more.size(); ++i) {
    sum[i] += scale * more[i];
  }
}

/// Adds the gradient of one load's error. At rest f(x, k) + f_ext = 0 with df/dx = -K, so that
/// dx/dk = K^-1 df/dk and de/dk = λ · df/dk with K λ = de/dx.
bool add_gradient(const SpringBody& body, const CalibrationLoad& load, const Positions& at,
                  ErrorMeasure measure, double share, SpringConstants& gradient) {
  const auto lambda =
      small_displacements(body, load.load.holds, at, load_error_gradient(load, at, measure));
  if (!lambda) {
    return false;
  }
  add_to(gradient.length,
         along(body.parts.edges, body.lengths, at, *lambda,
               [](const Spring& s, const Points2& p) { return length_forces(s, p); }),
         share);
  add_to(
      gradient.area,
      along(body.parts.faces, body.areas, at, *lambda,
            [](const Spring& s, const Points3& p) { return area_forces(s, p, ForceForm::kExact); }),
      share);
  add_to(gradient.volume,
         along(body.tetrahedra, body.volumes, at, *lambda,
               [](const Spring& s, const Points4& p) {
                 return volume_forces(s, p, ForceForm::kExact);
               }),
         share);
  return true;
}

std::string why_unstable(const LoadCase& load, const Equilibrium& found) {
  if (found.outcome == Settling::kSettled) {
    return fmt::format("load '{}' turns {} tetrahedra inside out", load.name, found.inverted);
  }
  return fmt::format("load '{}' {}", load.name,
                     found.outcome == Settling::kUnstable ? "is not stable" : "does not rest");
}

}  // namespace

CalibrationProblem::CalibrationProblem(SpringBody body, std::vector<CalibrationLoad> loads,
                                       ErrorMeasure measure)
    : body_(std::move(body)), loads_(std::move(loads)), measure_(measure) {
  if (loads_.empty()) {
    throw InputError("calibration: there is no load");
  }
  geometry::TetMesh mesh;
  mesh.vertices.assign(body_.rest.begin(), body_.rest.end());
  mesh.tetrahedra.assign(body_.tetrahedra.begin(), body_.tetrahedra.end());
  for (const CalibrationLoad& load : loads_) {
    check_load(mesh, load.load);
    check_reference(body_, load);
    check_measure(load, measure_);
  }
}

namespace {

/// Contribution of one load.
struct LoadAnswer {
  double error{};
  SpringConstants gradient;
  std::string unstable;
};

LoadAnswer answer_of(const SpringBody& body, const CalibrationLoad& load, ErrorMeasure measure,
                     bool with_gradient, double share) {
  LoadAnswer answer;
  const Equilibrium found =
      equilibrium(body, load.load, {.iterations = kIterations}, load.reference);
  if (found.outcome != Settling::kSettled || found.inverted > 0) {
    answer.unstable = why_unstable(load.load, found);
    return answer;
  }
  answer.error = load_error(load, found.positions, measure);
  if (with_gradient &&
      !add_gradient(body, load, found.positions, measure, share, answer.gradient)) {
    answer.unstable = fmt::format("load '{}' is not stable", load.load.name);
  }
  return answer;
}

}  // namespace

CalibrationError CalibrationProblem::error(const SpringConstants& constants, bool with_gradient,
                                           int threads) const {
  SpringBody body = body_;
  check_constants(body, constants);
  body.constants = constants;
  const double share = 1.0 / static_cast<double>(loads_.size());
  std::vector<LoadAnswer> answers(loads_.size());
  parallel_for(loads_.size(), std::max(threads, 1), [&](std::size_t i) {
    answers[i] = answer_of(body, loads_[i], measure_, with_gradient, share);
  });
  CalibrationError result;
  double sum = 0.0;
  for (const LoadAnswer& answer : answers) {
    if (!answer.unstable.empty()) {
      return {.by_load = {}, .unstable = answer.unstable, .gradient = {}};
    }
    result.by_load.push_back(answer.error);
    sum += share * answer.error;
    if (with_gradient) {
      add_to(result.gradient.length, answer.gradient.length, 1.0);
      add_to(result.gradient.area, answer.gradient.area, 1.0);
      add_to(result.gradient.volume, answer.gradient.volume, 1.0);
    }
  }
  result.mean = sum;
  return result;
}

Positions CalibrationProblem::rest(const SpringConstants& constants, std::size_t load) const {
  SpringBody body = body_;
  check_constants(body, constants);
  body.constants = constants;
  const Equilibrium found =
      equilibrium(body, loads_.at(load).load, {.iterations = kIterations}, loads_[load].reference);
  return found.outcome == Settling::kSettled ? found.positions : Positions();
}

}  // namespace haptrial::deformable
