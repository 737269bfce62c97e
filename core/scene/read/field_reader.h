#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/definition/table.h"
#include "core/control/pd_controller.h"
#include "core/scene/read/number_source.h"

namespace haptrial::scene {

// Bounds of quantities that many fields have.
inline constexpr Bounds kPlaceBounds{-1.0, 1.0};             // [m]
inline constexpr Bounds kLengthBounds{0.0, 1.0, true};       // [m]
inline constexpr Bounds kForceBounds{-100.0, 100.0};         // [N]
inline constexpr Bounds kStrengthBounds{0.0, 100.0};         // [N]
inline constexpr Bounds kStiffnessBounds{0.0, 1e5};          // [N/m]
inline constexpr Bounds kDampingBounds{0.0, 1e4};            // [N·s/m]
inline constexpr Bounds kDurationBounds{0.0, 3600.0, true};  // [s]
inline constexpr Bounds kFadeBounds{0.0, 60.0};              // [s]
inline constexpr Bounds kFilterBounds{0.0, 1e5, true};       // [Hz]
inline constexpr Bounds kDirectionBounds{-1e3, 1e3};

/// The keys of one field or region, with defaults for those that may be left out.
struct FieldReader {
  Table& table;
  const NumberSource& source;
  double rate{1000.0};  // of the servo loop [Hz]
  double limit{10.0};   // of the field [N]

  double number(std::string_view key, const Bounds& bounds, std::string_view unit) const {
    return source.number(table, key, bounds, unit);
  }
  double number_or(double otherwise, std::string_view key, const Bounds& bounds,
                   std::string_view unit) const {
    table.otherwise(key, otherwise);
    return table.has(key) ? number(key, bounds, unit) : otherwise;
  }
  Eigen::Vector3d vector(std::string_view key, const Bounds& bounds, std::string_view unit) const {
    return source.vector(table, key, bounds, unit);
  }
  Eigen::Vector3d place(std::string_view key) const { return vector(key, kPlaceBounds, "m"); }
  /// Any length but 0; y after a problem.
  Eigen::Vector3d direction(std::string_view key) const;
  Eigen::Vector3d direction_or(const Eigen::Vector3d& otherwise, std::string_view key) const {
    return table.has(key) ? direction(key) : otherwise;
  }
  control::PdGains gains() const;
  /// Below half the loop's rate.
  double frequency(std::string_view key) const;
  std::uint64_t seed() const;
  std::string text_or_none(std::string_view key) const {
    return table.has(key) ? table.text(key) : "";
  }
};

}  // namespace haptrial::scene
