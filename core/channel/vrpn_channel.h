#pragma once

#include "core/channel/channel_kind.h"

namespace haptrial::channel {

/// Kind `vrpn`: a sensor of a tracker behind a VRPN server (OptiTrack, Vicon, PhaseSpace, Polhemus
/// and others), over one TCP connection. Position [m] and orientation (unit quaternion) are in the
/// tracker's own frame.
const ChannelKind& vrpn_channel();

}  // namespace haptrial::channel
