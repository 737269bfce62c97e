#include <cmath>
#include <numbers>

#include "core/base/instruction_set.h"
#include "core/geometry/volume/boundary_cone.h"
#include "core/geometry/volume/winding_sums_internal.h"

namespace haptrial::geometry {
namespace kernel {

void sum_windings_baseline(const float* corners, std::size_t triangles, const PointLanes& points,
                           float* re, float* im, float* turns) {
  sum_windings(corners, triangles, points, re, im, turns);
}

}  // namespace kernel

void winding_sums(std::span<const Eigen::Vector3f> corners, const PointLanes& points,
                  std::array<float, kPointLanes>& sums, InstructionSet set) {
  const auto sum =
      choose(set, kernel::sum_windings_baseline, HAPTRIAL_X86(kernel::sum_windings_avx2));
  alignas(64) std::array<float, kPointLanes> re;
  alignas(64) std::array<float, kPointLanes> im{};
  alignas(64) std::array<float, kPointLanes> turns{};
  re.fill(1.0f);
  sum(corners.empty() ? nullptr : corners[0].data(), corners.size() / 3, points, re.data(),
      im.data(), turns.data());
  for (std::size_t l = 0; l < sums.size(); ++l) {
    sums[l] = std::atan2(im[l], re[l]) / (2.0f * std::numbers::pi_v<float>)+turns[l];
  }
}

void winding_sums(std::span<const Eigen::Vector3f> corners, const PointLanes& points,
                  std::array<float, kPointLanes>& sums) {
  static const InstructionSet best = best_instruction_set();
  winding_sums(corners, points, sums, best);
}

}  // namespace haptrial::geometry
