#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/document/figure.h"
#include "analysis/reaching/exponential_fit.h"
#include "analysis/reaching/learning_curve.h"
#include "analysis/reaching/reach.h"

namespace haptrial::analysis {

/// The mean of reaches: at equal parts of their times from onset to end.
struct TimedReach {
  Reach reach;
  double onset{0.0};  // as Reach::time [s]
  double end{0.0};
};

/// @param samples  of the mean, >= 2. @throws std::invalid_argument when there is no reach or the
/// recording does not reach from onset to end.
std::vector<Eigen::Vector3d> mean_path(std::span<const TimedReach> reaches,
                                       std::size_t samples = 101);

/// The speed of one reach at equal times from its onset on, until the recording ends; at most for
/// kProfileTime. @throws std::invalid_argument when the onset is outside of the recording.
inline constexpr double kProfileStep = 0.01;                 // [s]
inline constexpr double kProfileTime = 1.5;                  // [s]
std::vector<double> speed_profile(const TimedReach& reach);  // [m/s]

/// The mean of such profiles at each time, as long as half of them last.
/// @throws std::invalid_argument when there is none
std::vector<double> mean_profile(std::span<const std::vector<double>> profiles);

/// One line of a figure of speeds.
struct DrawnProfile {
  std::string label;
  std::size_t block{0};       // gives its colour
  const char* dash{"solid"};  // as Look::dash
  std::vector<double> speed;  // as mean_profile [m/s]
};

/// "Speed profiles" over the time since onset. @param simulated  marks the figure.
Figure speed_figure(std::span<const DrawnProfile> profiles, bool simulated);

/// The paths of a block, one for each target as a rule (mean_path).
struct BlockPaths {
  std::string block;  // as in the definition
  Eigen::Vector3d start{0.0, 0.0, 0.0};
  std::vector<Eigen::Vector3d> targets;
  std::vector<std::vector<Eigen::Vector3d>> paths;  // in W [m]
};

/// "Trajectories by block": a figure for each block, all to the same scale, from above (x to the
/// right, z downwards) in cm. @param simulated  marks the figures.
std::vector<Figure> trajectory_figures(std::span<const BlockPaths> blocks, bool simulated);

/// One curve of a learning figure: a group, or catch trials beside field trials.
struct DrawnCurve {
  std::string label;
  std::vector<CyclePoint> points;
  double first_cycle{1.0};            // number of the first cycle on the axis
  std::optional<ExponentialFit> fit;  // drawn over the curve's own cycles
};

/// Start of a block on the axis of cycles.
struct BlockStart {
  std::string block;
  double first_cycle{1.0};
};

struct LearningFigure {
  std::string name{"learning-curve"};  // of the files
  std::string title{"Learning curve"};
  std::string metric;  // label of the axis, with its unit
  double scale{1.0};   // drawn = scale · value: 1000 for millimetres
  std::vector<DrawnCurve> curves;
  std::vector<BlockStart> blocks;
  bool within{false};  // intervals within participants, otherwise between them
  bool simulated{false};
};

/// "Learning curve": means of the cycles with 95 % intervals, as learning_curve gives them.
Figure learning_figure(const LearningFigure& drawn);

}  // namespace haptrial::analysis
