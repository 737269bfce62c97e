#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/definition/table.h"
#include "core/channel/channel_source.h"
#include "core/channel/sample_clock.h"

namespace haptrial::channel {

/// One channel as its keys ask for it.
struct ChannelPlan {
  std::vector<Quantity> quantities;  // 1 to kMostQuantities; none: the kind gives messages alone
  std::string path{};                // of a line that one reader has alone; empty: none
  double rate{0.0};                  // samples a second, as far as it is known; 0: it is not [Hz]
  double patience{1.0};              // without data the channel is lost > 0 [s]
  ClockOptions clock;
  /// Opens the instrument; may wait for seconds. @throws RunError in one sentence if it does not
  /// answer
  std::function<std::unique_ptr<ChannelSource>()> open;
};

/// One kind of [channels]: what its `kind` says, and how its keys are read.
struct ChannelKind {
  std::string word;
  std::string what;  // one line for lists: which instruments
  /// Problems are noted in the table.
  std::function<ChannelPlan(Table& table)> read;
};

/// Quantities that a definition names: `quantities = { force = "N", time = "s" }`, in the order of
/// the text.
std::vector<Quantity> read_quantities(Table& table, std::string_view key);
/// Notes the problems of quantities that stand under `key`: their names, and how many there are.
void check_quantities(Table& table, std::string_view key, std::vector<Quantity>& quantities);

/// Every kind that read_channels() knows. Call before threads are started.
const std::vector<ChannelKind>& kinds_of_channel();

/// Adds a kind of a program's own.
/// @throws std::invalid_argument for a word that is taken
void add_kind_of_channel(const ChannelKind& kind);

// The shipped kinds.

/// The kind `labjack`: analogue inputs of LabJack T4, T7 and T8, which are asked over Modbus TCP.
const ChannelKind& labjack_channel();

/// Kind `line`: an instrument that prints a line of numbers for each sample, over a serial line or
/// a named pipe. Boards with a program of one's own, load cells and grip sensors do.
/// docs/channels.md has its keys.
ChannelKind line_channel();

/// Kind `lsl`: a stream of the Lab Streaming Layer. Numbers become samples and texts messages, each
/// at the time of its stamp; every offset of the sender's clock that the layer measures is kept.
/// docs/channels.md has its keys.
ChannelKind lsl_channel();

/// Kind `neon`: state of a Pupil Labs Neon eye tracker, asked over HTTP, and its own recording,
/// which begins and ends with the channel. Gaze comes as a stream of kind `lsl`. docs/channels.md
/// has its keys.
ChannelKind neon_channel();

/// The kind `rdt`: force-torque sensors that send RDT records over UDP (ATI Net F/T and Axia,
/// Schunk FTN-Axia, OnRobot). Force [N] and torque [N·m] are in the sensor's own frame.
const ChannelKind& rdt_channel();

/// The kind `robotiq`: force-torque sensors FT 150 and FT 300, which send 100 frames a second over
/// a serial line. Force [N] and torque [N·m] are in the sensor's own frame.
const ChannelKind& robotiq_channel();

/// Kind `vrpn`: a sensor of a tracker behind a VRPN server (OptiTrack, Vicon, PhaseSpace, Polhemus
/// and others), over one TCP connection. Position [m] and orientation (unit quaternion) are in the
/// tracker's own frame.
const ChannelKind& vrpn_channel();

}  // namespace haptrial::channel
