#pragma once

#include <Eigen/Core>
#include <array>

#include "core/base/definition/schema_forward.h"
#include "core/base/random.h"
#include "core/subject/force_memory.h"
#include "core/subject/hand_parameters.h"

namespace haptrial::subject {

template <class Person>
struct Population;

/// How somebody learns where a path goes. Sources: docs/algorithms/tutoring-study.md.
struct PathParameters {
  double visual_noise{0.006};  // of a place that was seen, in memory [m]
  double haptic_noise{0.008};  // of a place to which the own hand was led [m]
  double forgetting{0.001};    // drift of the memory between passes [m]
  double correlation{1.5};     // time over which these errors are alike [s]
};

/// The keys of [path_memory], which say how each parameter varies over people. Their streams are
/// their own, so that nothing else about a person changes.
const Schema<Population<PathParameters>>& path_memory_schema();

/// Remembers a path in the xz plane and moves a hand along it again. What was seen and what was
/// felt of one exposure combine by their variances (Ernst and Banks 2002); exposures of a block are
/// merged as those of forces are (ForceMemory, here of metres in place of newtons).
class PathLearner {
 public:
  PathLearner(const PathParameters& person, const HandParameters& hand,
              RandomStream random) noexcept;

  // Servo thread.
  /// @param duration  of the pass [s]  @param another  a path that is not known yet
  void begin(double duration, bool another) noexcept;
  /// @param place  of what moves along the path, p_W [m]
  void take(double progress, const Eigen::Vector3d& place, bool seen, bool felt) noexcept;
  void end() noexcept;
  /// The force of the arm that carries the hand to where it remembers the path to be, in W [N];
  /// without a memory it stays where it is.
  Eigen::Vector3d drive(double progress, const Eigen::Vector3d& hand) noexcept;

 private:
  static constexpr int kKnots = ForceProfile::kKnots;

  Eigen::Vector3d remembered(double progress) const noexcept;
  void learn(int axis) noexcept;

  PathParameters person_;
  double drag_;  // of the hand at a steady speed [N·s/m]
  RandomStream random_;
  std::array<ForceMemory, 2> memory_;  // x and z
  std::array<std::array<double, kKnots>, 2> sums_{};
  std::array<int, kKnots> counts_{};
  bool seen_{false};
  bool felt_{false};
  bool begun_{false};  // to move
  double duration_{1.0};
  Eigen::Vector3d offset_{Eigen::Vector3d::Zero()};  // of the hand at the start from its memory
};

}  // namespace haptrial::subject
