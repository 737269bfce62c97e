#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace haptrial::subject {

/// Palpation: the hand goes from place to place and presses at each, with the same force, as people
/// look for something hard in what is soft (pressure: Lederman and Klatzky 1987).
struct Palpate {
  static constexpr std::size_t kMost = 16;
  std::array<Eigen::Vector3d, kMost> places{};  // where presses begin, in W [m]
  std::size_t count{0};                         // 1 to kMost; after the last the hand rests there
  Eigen::Vector3d direction{0.0, -1.0, 0.0};    // of a press, any length above 0
  double force{1.0};                            // > 0 [N]
  double move{0.4};                             // to a place > 0 [s]
  double press{0.8};                            // there: half of it on, a quarter held > 0 [s]
};

/// @throws std::invalid_argument naming the parameter that breaks its bound.
void check(const Palpate& palpate);

/// State of a palpation at a time.
struct PalpationStep {
  std::size_t place{0};  // towards which, or at which
  double moved{0.0};     // of the way to it, 0 to 1
  double pressed{0.0};   // of the force, 0 to 1; above 0 only at a place
  bool pressing{false};  // at the place: the hand is free along the direction
  bool over{false};
};

/// @param time  since it began [s]. Servo thread: no allocation, lock, I/O or throw.
PalpationStep palpation_at(const Palpate& palpate, double time) noexcept;

}  // namespace haptrial::subject
