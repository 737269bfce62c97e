#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "analysis/contact/exam/exam_bodies.h"
#include "analysis/contact/truth/true_contact.h"

namespace haptrial::test {

using namespace evaluation;

inline constexpr double kTruthStiffness = 500.0;  // [N/m]

using Surface = std::function<Eigen::Vector3d(double, double)>;

struct SurfaceByTwo {
  Surface surface;
  std::function<std::array<double, 2>(const Eigen::Vector3d&)> place;  // of a point on it
};

/// A body whose contact is known, its surface by two parameters, and a tool that rubs it.
struct TruthCase {
  const char* name;
  TrueBody body;
  Surface surface;  // by two parameters, lengths [m]
  std::function<std::array<double, 2>(const Eigen::Vector3d&)> place;  // of a point on it
  Eigen::Vector3d (*tool)(double t);                                   // of the exam

  std::vector<Eigen::Vector3d> path() const {
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i <= 4000; ++i) {
      points.push_back(tool(1e-3 * i));
    }
    return points;
  }
  /// Slower where it turns, so that friction holds it for a while.
  std::vector<Eigen::Vector3d> there_and_back() const {
    return evaluation::there_and_back({name, body, tool});
  }
};

/// Bodies and tools of the exam; the surfaces are stated here once more, by other formulas.
inline std::vector<TruthCase> truth_cases() {
  using Eigen::Vector3d;
  const double flank = 0.6, pi = std::numbers::pi;
  const double c = std::cos(flank), s = std::sin(flank);
  const auto by_x = [](const Vector3d& p) { return std::array{p.x(), p.z()}; };
  const auto along_flank = [c](const Vector3d& p) { return std::array{p.x() / c, p.z()}; };
  const std::vector<SurfaceByTwo> surfaces{
      {[](double u, double v) { return Vector3d(u, 0.0, v); }, by_x},
      {[](double u, double v) {
         return Vector3d(0.05 * std::cos(v) * std::cos(u), 0.05 * std::cos(v) * std::sin(u),
                         0.05 * std::sin(v));
       },
       [](const Vector3d& p) {
         return std::array{std::atan2(p.y(), p.x()), std::asin(p.z() / 0.05)};
       }},
      {[](double u, double v) { return Vector3d(0.03 * std::cos(u), 0.03 * std::sin(u), v); },
       [](const Vector3d& p) {
         return std::array{std::atan2(p.y(), p.x()), p.z()};
       }},
      {[](double u, double v) {
         const double out = 0.04 + 0.015 * std::cos(v);
         return Vector3d(out * std::cos(u), out * std::sin(u), 0.015 * std::sin(v));
       },
       [](const Vector3d& p) {
         return std::array{std::atan2(p.y(), p.x()), std::atan2(p.z(), p.head<2>().norm() - 0.04)};
       }},
      {[c, s](double u, double v) { return Vector3d(c * u, -s * std::abs(u), v); }, along_flank},
      {[c, s](double u, double v) { return Vector3d(c * u, s * std::abs(u), v); }, along_flank},
      {[pi](double u, double v) { return Vector3d(u, 0.001 * std::sin(2.0 * pi * u / 0.02), v); },
       by_x},
      {[](double u, double v) {  // round the rim: the upper side, the side at +x, the lower one
         const double x = std::min(u, 0.015), y = std::clamp(0.001 - (u - 0.015), -0.001, 0.001);
         return u < 0.017 ? Vector3d(x, y, v) : Vector3d(0.015 - (u - 0.017), -0.001, v);
       },
       [](const Vector3d& p) {
         return std::array{p.x() < 0.015     ? (p.y() > 0.0 ? p.x() : 0.032 - p.x())
                           : p.y() <= -0.001 ? 0.017
                                             : 0.016 - p.y(),
                           p.z()};
       }}};
  std::vector<TruthCase> cases;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const ExamBody& body = exam_bodies()[i];
    cases.push_back(
        {body.name.c_str(), body.body, surfaces[i].surface, surfaces[i].place, body.tool});
  }
  return cases;
}

}  // namespace haptrial::test
