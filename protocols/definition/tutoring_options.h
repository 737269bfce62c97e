#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/definition/given_in.h"
#include "core/tutoring/coupled_side.h"
#include "core/tutoring/simulated_channel.h"
#include "core/tutoring/tutoring_law.h"

namespace haptrial {
template <class T>
class Schema;
namespace device {
struct DeviceReading;
}
}  // namespace haptrial

namespace haptrial::protocols {

/// A network over which some of the trials go.
struct TutoringNetwork {
  std::string name;
  tutoring::ChannelConditions channel;  // each way
};

/// How a tutor leads, the table [tutoring] of a definition: in a recorded run or over a link.
struct TutoringOptions {
  GivenIn led;  // trials that a tutor leads, of sessions that give anything
  tutoring::TutoringGains gains;
  double ramp{0.5};                // from no lead to all of it, and back [s]
  double speed{1.0};               // of a playback, 0.5 to 1 of the original
  std::uint32_t pause_buttons{0};  // a playback waits while one is pressed: bit i, button i
  std::vector<int> pause_keys;     // or one of the window's is held: codes
  double most_force{12.0};         // of own world, tutor and coupling together: the envelope's [N]

  // Over a link.
  double authority{1.0};  // of who teaches over the other hand, 0 to 1
  double felt_back{1.0};  // of the coupling that is felt by who leads, 0 to 1
  tutoring::Passivity passivity{tutoring::Passivity::kTank};
  bool deadband{false};                 // only messages that would be missed are sent
  bool jitter_buffer{false};            // the partner's ticks as evenly as they were sent
  double deadline{0.1};                 // silence after which the force is zero [s]
  double patience{10.0};                // silence after which the session ends [s]
  tutoring::ChannelConditions channel;  // of a dry run, each way
  /// Networks of a dry run, one for each trial; if there are none, `channel` serves all trials.
  std::vector<TutoringNetwork> networks;
};

/// The bit of DeviceReading::keys that a key of `pause_keys` sets; no function of a protocol's has
/// it.
inline constexpr std::uint32_t kPauseBit = std::uint32_t{1} << 31;

/// The keys of [tutoring].
const Schema<TutoringOptions>& tutoring_schema();

/// Whether who is led asks a playback to wait. Servo thread.
bool asks_to_wait(const TutoringOptions& options, const device::DeviceReading& reading) noexcept;

/// Parameters of one side of a link.
tutoring::SideParameters side_parameters(const TutoringOptions& options);

}  // namespace haptrial::protocols
