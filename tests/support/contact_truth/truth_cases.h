#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "tests/support/contact_truth/true_contact.h"

namespace haptrial::test {

using namespace evaluation;

inline constexpr double kTruthStiffness = 500.0;  // [N/m]

using Surface = std::function<Eigen::Vector3d(double, double)>;

/// A body whose contact is known, its surface by two parameters, and a tool that rubs it.
struct TruthCase {
  const char* name;
  TrueBody body;
  Surface surface;  // by two parameters, lengths [m]
  std::function<std::array<double, 2>(const Eigen::Vector3d&)> place;  // of a point on it
  std::function<Eigen::Vector3d(double)> tool;                         // t from 0, in the air there

  std::vector<Eigen::Vector3d> path() const {
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i <= 4000; ++i) {
      points.push_back(tool(1e-3 * i));
    }
    return points;
  }
  /// Slower where it turns, so that friction holds it for a while.
  std::vector<Eigen::Vector3d> there_and_back() const {
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i <= 4000; ++i) {
      points.push_back(tool(1.5 * (1.0 - std::cos(std::numbers::pi * i / 2000.0))));
    }
    return points;
  }
};

inline double sway(double t) { return 0.02 * std::sin(2.3 * t); }
inline double dip(double t) { return 0.004 * std::cos(5.0 * t) - 0.0035 * (1.0 - std::exp(-t)); }

inline std::vector<TruthCase> truth_cases() {
  using Eigen::Vector3d;
  const double flank = 0.6, pi = std::numbers::pi;
  const double c = std::cos(flank), s = std::sin(flank);
  const auto by_x = [](const Eigen::Vector3d& p) { return std::array{p.x(), p.z()}; };
  return {
      {"plane", TruePlane{}, [](double u, double v) { return Vector3d(u, 0.0, v); }, by_x,
       [](double t) { return Vector3d(sway(t), dip(t), 0.3 * sway(2.0 * t)); }},
      {"sphere", TrueSphere{0.05},
       [](double u, double v) {
         return Vector3d(0.05 * std::cos(v) * std::cos(u), 0.05 * std::cos(v) * std::sin(u),
                         0.05 * std::sin(v));
       },
       [](const Eigen::Vector3d& p) {
         return std::array{std::atan2(p.y(), p.x()), std::asin(p.z() / 0.05)};
       },
       [](double t) {
         const double a = 0.4 + sway(t) / 0.02, b = 0.6 * std::sin(t);
         return Vector3d((0.05 + dip(t)) * Vector3d(std::cos(b) * std::cos(a),
                                                    std::cos(b) * std::sin(a), std::sin(b)));
       }},
      {"cylinder", TrueCylinder{0.03},
       [](double u, double v) { return Vector3d(0.03 * std::cos(u), 0.03 * std::sin(u), v); },
       [](const Eigen::Vector3d& p) {
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
       [](const Eigen::Vector3d& p) {
         return std::array{std::atan2(p.y(), p.x()), std::atan2(p.z(), p.head<2>().norm() - 0.04)};
       },
       [](double t) {
         const double a = sway(t) / 0.02, b = 2.0 * std::sin(0.9 * t), r = 0.015 + dip(t);
         const double out = 0.04 + r * std::cos(b);
         return Vector3d(out * std::cos(a), out * std::sin(a), r * std::sin(b));
       }},
      {"wedge", TrueWedge{flank},
       [c, s](double u, double v) { return Vector3d(c * u, -s * std::abs(u), v); },
       [c](const Eigen::Vector3d& p) {
         return std::array{p.x() / c, p.z()};
       },
       [](double t) {
         const double x = 0.4 * sway(t);
         return Vector3d(x, -0.684 * std::abs(x) + dip(t), sway(0.7 * t));
       }},
      {"concave edge", TrueConcaveEdge{flank},
       [c, s](double u, double v) { return Vector3d(c * u, s * std::abs(u), v); },
       [c](const Eigen::Vector3d& p) {
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
       [](const Eigen::Vector3d& p) {
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

}  // namespace haptrial::test
