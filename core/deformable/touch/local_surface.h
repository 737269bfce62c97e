#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/deformable/touch/normal_forces.h"
#include "core/deformable/touch/surface_samples.h"

namespace haptrial::deformable {

/// The surface of a moving body near the ball that presses it, at one time, and how it gives way.
struct LocalSurface {
  static constexpr std::size_t kMost = PressedPlaces::kMost;

  struct Place {
    SurfaceSamples::Sample sample;
    Eigen::Vector3d rest{Eigen::Vector3d::Zero()};   // of the undeformed body [m]
    Eigen::Vector3d at{Eigen::Vector3d::Zero()};     // now [m]
    Eigen::Vector3d free{Eigen::Vector3d::Zero()};   // now, without normal forces [m]
    Eigen::Vector3d drift{Eigen::Vector3d::Zero()};  // how fast that moves [m/s]
    bool pressed{false};
  };

  std::uint64_t generation{0};  // of the start() that it follows
  std::size_t count{0};
  std::array<Place, kMost> places;
  // (i, j): of i by forces on j [m/N]
  std::vector<Eigen::Matrix3f> gives = std::vector<Eigen::Matrix3f>(kMost * kMost);
  double radius{};                                        // of the ball, now [m]
  Eigen::Vector3d tool{Eigen::Vector3d::Zero()};          // now [m]
  Eigen::Vector3d friction{Eigen::Vector3d::Zero()};      // of the ball on the body [N]
  bool touches{false};                                    // the ball presses it
  bool slips{false};                                      // and slips
  bool crowded{false};                                    // more places than fit
  double most_force{std::numeric_limits<double>::max()};  // before a tetrahedron is inside out [N]
  std::uint64_t inverted{0};     // ticks so far on which one would have been
  std::uint64_t flown_apart{0};  // likewise: put to rest

  Eigen::Matrix3f& give(std::size_t i, std::size_t j) noexcept { return gives[i * kMost + j]; }
  const Eigen::Matrix3f& give(std::size_t i, std::size_t j) const noexcept {
    return gives[i * kMost + j];
  }
};

}  // namespace haptrial::deformable
