#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "protocols/interface/protocol.h"

namespace haptrial::experiments {

/// A stage of a virtual trial.
struct VirtualStage {
  std::string name;
  int interval{0};              // from 1
  double begin{0.0}, end{0.0};  // [s]
};

/// One trial of a virtual participant, tick by tick, on a simulated clock and in memory.
struct VirtualTrial {
  std::vector<double> times;                // since the trial began [s]
  std::vector<Eigen::Vector3d> positions;   // (times) of the first device's tip, in W [m]
  std::vector<Eigen::Vector3d> velocities;  // likewise [m/s]
  std::vector<Eigen::Vector3d> forces;      // that the device gives, in W [N]
  std::vector<VirtualStage> stages;         // those of /samples, if the protocol records none
  std::vector<std::string> answers;         // "stiffer: first", in their order
  bool completed{false};
  std::string why;  // it was not completed; empty: it was
};

/// Presents one trial to the participant whom a dry run with the same seed has in its first
/// session. Earlier trials are taken as done, without answers.
/// @param definition  of the protocol, loaded
/// @param number   of the trial in the session, practice included, from 1
/// @param longest  simulated time after which the trial is left [s]
/// @throws InputError for a number beyond the session
VirtualTrial virtual_trial(const protocols::Protocol& protocol,
                           const protocols::Definition& definition,
                           const protocols::SessionPlace& place, int number, double longest);

}  // namespace haptrial::experiments
