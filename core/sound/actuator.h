#pragma once

#include <string>
#include <vector>

namespace haptrial {
class Table;
}

namespace haptrial::sound {

/// A vibrotactile actuator on a channel of the sound card, as it was calibrated: what a signal of
/// full scale makes of it, with its amplifier and whoever wears it.
struct Actuator {
  std::string name;
  int channel{3};          // of the card, from 1
  double full_scale{1.0};  // peak that full scale gives > 0 [unit]
  std::string unit;        // "m/s²", "g", "N", as it was measured
  double lowest{20.0};     // frequencies for which that holds, 0 < lowest < highest [Hz]
  double highest{1000.0};
};

/// Reads [actuators.NAME] of a definition or lab file, in the order of the file; none without the
/// table. Problems are noted.
std::vector<Actuator> read_actuators(Table& root);

}  // namespace haptrial::sound
