#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "core/record/rows/session_types.h"

namespace haptrial::analysis {

/// A session whose curves are known: what the recorder would have written of a participant who does
/// exactly this.
struct SyntheticSession {
  std::string subject{"P01"};
  int session{1};
  bool simulated{true};
  std::string clock{"simulated"};
  double rate{250.0};   // [Hz]
  double seconds{5.0};  // of a pass
  int blocks{3};        // conditions in turn: haptic, visual, visuohaptic
  int repetitions{3};
  double lag{0.0};                                  // of the hand behind the path [s]
  Eigen::Vector3d offset{Eigen::Vector3d::Zero()};  // of the hand from the path [m]
  int aborted_trial{0};                             // its test pass is aborted; 0 for none
  int untrained_trial{0};          // its training pass is aborted, its test pass is not
  int untested_trial{0};           // has no test pass
  int damaged_trial{0};            // a tick of its test pass never reached the file
  bool stimulus_backwards{false};  // the rows of /stimuli are in the wrong order
  bool finished{true};             // else the session was killed after its last pass
  int repeated_trial{0};           // has two test passes, the first with twice the force
  double force_limit{0.0};         // the applied force saturates here; 0: nowhere [N]
  int second_attempt{0};           // trial that was aborted before; 0 for none
  int reduced_trial{0};            // the damping of its training was reduced for a second
  int frozen_trial{0};             // half of the frames of its training were dropped; else none

  /// Target force [N] of a time since the start of the run [s].
  std::function<double(double)> target;
  /// Applied force [N] of condition, trial, time [s] and target force [N].
  std::function<double(const std::string&, int, double, double)> applied;
};

/// Ideal z of the path [m].
double synthetic_path_z(double time);

/// Writes it as a session file.
void write_session(const std::filesystem::path& file, const SyntheticSession& session);

}  // namespace haptrial::analysis
