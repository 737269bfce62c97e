#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/deformable/springs/spring_body.h"

namespace haptrial::deformable {

enum class SpringKind { kLength, kArea, kVolume };
inline constexpr std::array kSpringKinds{SpringKind::kLength, SpringKind::kArea,
                                         SpringKind::kVolume};

/// Share of a parameter in a spring's constant.
struct ParameterShare {
  std::int32_t parameter;
  double weight;
};

/// Numbers that say every constant of a body of springs: the common logarithms of the constants
/// [J] that calibration varies. Lengths first, then areas, then volumes.
/// Source: Morris 2006, §5.3.3 (homogeneous), §5.3.5 (on a grid).
class SpringParameters {
 public:
  /// Three: every edge, face and tetrahedron alike.
  static SpringParameters uniform(const SpringBody& body);
  /// Three for every node of a SpringGrid that has influence.
  /// @throws InputError as SpringGrid.
  static SpringParameters on_grid(const SpringBody& body, const std::array<int, 3>& nodes);
  /// One for every edge, face and tetrahedron.
  static SpringParameters by_element(const SpringBody& body);

  /// Returns these parameters with each spring's constant multiplied by the sum of the weights of
  /// the tetrahedra that have the spring, relative to the mean of its kind. With volumes as weights
  /// even parameters are an even density of energy; without them a spring on the surface, in one
  /// tetrahedron, resists like one inside, in many, and even parameters are no even body.
  /// @param weights  of the tetrahedra, each above 0
  SpringParameters weighted(const SpringBody& body, std::span<const double> weights) const;

  std::size_t size() const { return first_[kSpringKinds.size()]; }
  /// The number of the first parameter of a kind, which are together.
  std::size_t first(SpringKind kind) const { return first_[static_cast<std::size_t>(kind)]; }
  /// One value for all parameters of a kind: lengths, areas and volumes.
  std::vector<double> even(std::span<const double, 3> logarithms) const;
  /// @param logarithms  size() of them
  SpringConstants constants(std::span<const double> logarithms) const;
  /// Gradient by the logarithms from the gradient `by_constant` by the springs' constants.
  std::vector<double> gradient(std::span<const double> logarithms,
                               const SpringConstants& by_constant) const;
  /// Shares of the parameters in the constant of one spring.
  std::span<const ParameterShare> shares(SpringKind kind, std::size_t spring) const;

 private:
  /// Shares of each spring of one kind, in compressed rows.
  struct Rows {
    std::vector<std::size_t> start{0};
    std::vector<ParameterShare> share;
  };
  template <std::size_t n>
  void set_rows(SpringKind kind, const std::vector<std::array<std::int32_t, n>>& springs,
                const std::vector<std::vector<ParameterShare>>& at_vertex);
  SpringParameters() = default;
  SpringParameters(const SpringBody& body, std::size_t nodes,
                   const std::vector<std::vector<ParameterShare>>& at_vertex);

  std::array<std::size_t, kSpringKinds.size() + 1> first_{};  // parameters of each kind
  std::array<Rows, kSpringKinds.size()> rows_;
};

/// The list of a kind.
const std::vector<double>& list_of(const SpringConstants& constants, SpringKind kind);
std::vector<double>& list_of(SpringConstants& constants, SpringKind kind);

}  // namespace haptrial::deformable
