#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/deformable/springs/law/spring_body.h"

namespace haptrial::deformable {

/// Few numbers that say every constant of a body of springs: the common logarithms of the constants
/// [J] that calibration varies. Lengths first, then areas, then volumes.
/// Source: Morris 2006, §5.3.3 (homogeneous), §5.3.5 (on a grid).
class SpringParameters {
 public:
  /// Three: every edge, face and tetrahedron alike.
  static SpringParameters uniform(const SpringBody& body);
  /// Three for every node of a SpringGrid that has influence.
  /// @throws InputError as SpringGrid.
  static SpringParameters on_grid(const SpringBody& body, const std::array<int, 3>& nodes);

  std::size_t size() const { return 3 * nodes_; }
  /// @param logarithms  size() of them
  SpringConstants constants(std::span<const double> logarithms) const;
  /// By the logarithms what `by_constant` is by the springs' constants.
  std::vector<double> gradient(std::span<const double> logarithms,
                               const SpringConstants& by_constant) const;
  /// The share that a parameter has in each spring's constant.
  SpringConstants shares(std::size_t parameter) const;

 private:
  struct Share {
    std::int32_t node;
    double weight;
  };
  /// Shares of each spring of one kind, in compressed rows.
  struct Rows {
    std::vector<std::size_t> start{0};
    std::vector<Share> share;
  };
  template <std::size_t n>
  static Rows rows_of(const std::vector<std::array<std::int32_t, n>>& springs,
                      const std::vector<std::vector<Share>>& at_vertex);
  SpringParameters(const SpringBody& body, std::size_t nodes,
                   const std::vector<std::vector<Share>>& at_vertex);

  std::size_t nodes_;
  std::array<Rows, 3> rows_;  // lengths, areas, volumes
};

}  // namespace haptrial::deformable
