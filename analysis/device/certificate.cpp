#include "analysis/device/certificate.h"

#include <algorithm>
#include <cmath>

namespace haptrial::analysis {
namespace {

/// The measured forces, each once: a slow sensor's are there for several ticks.
std::vector<Eigen::Vector3d> each_measurement(const PartRecord& part) {
  if (part.measured_at.size() != part.measured.size()) {
    return part.measured;
  }
  std::vector<Eigen::Vector3d> each;
  for (std::size_t i = 0; i < part.measured.size(); ++i) {
    if (i == 0 || part.measured_at[i] != part.measured_at[i - 1]) {
      each.push_back(part.measured[i]);
    }
  }
  return each;
}

double square_along(const Eigen::Vector3d& v, const DrivenAxes& axes) {
  double square = 0.0;
  for (const int axis : axes) {
    square += v[axis] * v[axis];
  }
  return square;
}

/// Standard deviation from differences of neighbours, so that a slow drift has no share in it.
Interval white_noise(const std::vector<Eigen::Vector3d>& rows, const DrivenAxes& axes) {
  const auto n = static_cast<double>(rows.size());
  const auto count = static_cast<double>(axes.size());
  double square = 0.0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    square += square_along(rows[i] - rows[i - 1], axes);
  }
  const double deviation = std::sqrt(square / (2.0 * count * (n - 1.0)));
  const double df = count * 2.0 * (n - 1.0) * (n - 1.0) / (3.0 * n - 4.0);
  return interval_of(deviation, deviation / std::sqrt(2.0 * df), df);
}

/// Standard deviation about the mean of each of twenty pieces, with the interval that the pieces
/// give: neighbours may be correlated.
Interval piecewise_noise(const std::vector<Eigen::Vector3d>& rows, const DrivenAxes& axes) {
  constexpr std::size_t kPieces = 20;
  const std::size_t length = rows.size() / kPieces;
  const auto count = static_cast<double>(axes.size());
  std::vector<double> variances;
  double mean = 0.0;
  for (std::size_t piece = 0; piece < kPieces && length > 1; ++piece) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < length; ++i) {
      sum += rows[piece * length + i] / static_cast<double>(length);
    }
    double square = 0.0;
    for (std::size_t i = 0; i < length; ++i) {
      square += square_along(rows[piece * length + i] - sum, axes);
    }
    variances.push_back(square / (count * (static_cast<double>(length) - 1.0)));
    mean += variances.back() / kPieces;
  }
  if (variances.empty()) {
    return {};
  }
  double spread = 0.0;
  for (const double variance : variances) {
    spread += (variance - mean) * (variance - mean);
  }
  const Interval variance =
      interval_of(mean, std::sqrt(spread / (kPieces * (kPieces - 1.0))), kPieces - 1.0);
  return {std::sqrt(mean), std::sqrt(std::max(variance.low, 0.0)), std::sqrt(variance.high),
          variance.df};
}

/// The smallest difference of neighbouring positions, if all are multiples of it; else 0.
double smallest_step(const std::vector<Eigen::Vector3d>& rows) {
  constexpr double kNothing = 1e-12;  // [m]
  double step = 0.0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double moved = std::abs(rows[i][axis] - rows[i - 1][axis]);
      step = moved > kNothing && (step == 0.0 || moved < step) ? moved : step;
    }
  }
  for (std::size_t i = 1; i < rows.size() && step > 0.0; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double steps = std::abs(rows[i][axis] - rows[i - 1][axis]) / step;
      if (std::abs(steps - std::round(steps)) > 0.05) {
        return 0.0;
      }
    }
  }
  return step;
}

std::optional<WallBracket> wall_bracket(const std::vector<WallStep>& walls) {
  if (walls.empty()) {
    return std::nullopt;
  }
  WallBracket bracket;
  for (const WallStep& wall : walls) {
    bracket.met = bracket.met && wall.met;
    if (wall.met && !wall.passive && (bracket.active == 0.0 || wall.stiffness < bracket.active)) {
      bracket.active = wall.stiffness;
    }
  }
  for (const WallStep& wall : walls) {
    if (wall.passive && (bracket.active == 0.0 || wall.stiffness < bracket.active)) {
      bracket.passive = std::max(bracket.passive, wall.stiffness);
    }
  }
  return bracket;
}

}  // namespace

CertificateResult identify_device(const CertificateRecord& record, const Excitation& excitation) {
  CertificateResult result;
  const PartRecord& rest = record.part(CertificatePart::kRest);
  if (const auto each = each_measurement(rest); each.size() > 2) {
    result.rest.sensor = white_noise(each, excitation.axes());
  }
  result.rest.position = piecewise_noise(rest.position, excitation.axes());
  result.rest.velocity = piecewise_noise(rest.velocity, excitation.axes());
  const PartRecord& moved = record.part(CertificatePart::kMove);
  result.rest.resolution = smallest_step(
      moved.position.empty() ? record.part(CertificatePart::kFree).position : moved.position);
  if (record.has_sensor(CertificatePart::kGrid)) {
    result.statics = identify_static_force(record, excitation);
  }
  if (record.has_sensor(CertificatePart::kFrequency)) {
    result.response = identify_frequency_response(record, excitation);
  }
  if (record.has_sensor(CertificatePart::kMove)) {
    result.motion = identify_motion(record, excitation);
  }
  if (!record.part(CertificatePart::kFree).position.empty()) {
    result.free = identify_free_motion(record, excitation, CertificatePart::kFree);
  }
  if (record.mass > 0.0 && !record.part(CertificatePart::kLoaded).position.empty()) {
    result.loaded = identify_free_motion(record, excitation, CertificatePart::kLoaded);
  }
  result.wall = wall_bracket(record.walls);
  return result;
}

}  // namespace haptrial::analysis
