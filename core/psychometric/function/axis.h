#pragma once

#include <string>

namespace haptrial::psychometric {

enum class Scale {
  kLinear,      // x = level - origin
  kLog10,       // x = log10(level - origin)
  kNaturalLog,  // x = ln(level - origin), as psignifit states widths of logarithmic functions
  kDecibel      // x = 20 log10(level - origin)
};

/// The axis on which a psychometric function, the steps of a staircase and the means of estimates
/// are stated. With a logarithmic scale and the reference stimulus for origin, x is a logarithm of
/// the difference to the reference.
struct Axis {
  Scale scale{Scale::kLinear};
  double origin{0.0};  // finite [unit of the level]
  std::string unit{};  // of the level, as a report shows it: "N/m"; empty: not stated

  /// x of a level; -infinity at and below the origin of a logarithmic scale.
  double at(double level) const noexcept;
  /// The level of x.
  double level(double x) const noexcept;
  /// dx / dlevel; +infinity at and below the origin of a logarithmic scale.
  double gradient(double level) const noexcept;
  /// The unit of x, and of a width: "N/m", "log10(N/m)", "ln(N/m)", "dB re 1 N/m".
  std::string x_unit() const;
};

}  // namespace haptrial::psychometric
