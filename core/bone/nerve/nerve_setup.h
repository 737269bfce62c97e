#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/base/definition/given_in.h"
#include "core/base/definition/schema_forward.h"
#include "core/bone/nerve/emg.h"
#include "core/bone/nerve/exposure.h"
#include "core/bone/nerve/monitor.h"

namespace haptrial::nerve {

/// A nerve that is watched, and the muscles that it moves.
struct WatchedNerve {
  std::string name;                    // of a structure of the bone, or of the curve
  std::vector<Eigen::Vector3d> curve;  // its points, in the bone's frame B [m]; none: a structure
  double radius{0.5e-3};               // of the curve [m]
  std::vector<std::string> channels;   // muscles, at least one
};

/// Nerve monitor of a definition. A model to train with: its figures are chosen.
struct NerveSetup {
  std::vector<WatchedNerve> nerves;  // with kMostChannels channels in all at most
  MonitorParameters monitor;         // rate aside, which follows from the loop's
  ExposureParameters exposure;
  EmgParameters emg;  // likewise
  StimulationParameters stimulation;
  double heat{1.0};              // that a newton under a turning burr gives [W/N]
  double current{0.5e-3};        // of a pulse of the probe [A]
  double pulses{3.0};            // of the probe a second [1/s]
  bool muted{false};             // at the beginning
  GivenIn heard{GivenIn::kAll};  // procedures in which the participant hears it; all are recorded

  std::size_t channels() const noexcept;
};

/// Samples of an electromyogram in a tick: the fewest that make 8,000 a second.
/// @param rate  of ticks [Hz]
std::size_t samples_a_tick(double rate) noexcept;

/// Reads a [nerve_monitor] table. @param rate  of ticks [Hz]
NerveSetup read_nerve_setup(Table& table, double rate);

}  // namespace haptrial::nerve
