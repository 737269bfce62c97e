#pragma once

#include "core/tutoring/reliable_stream.h"

namespace haptrial::protocols {

/// Simulation that two linked sessions share: the world of the side that teaches; that of the other
/// side follows it by the bytes that one side gives and the other takes. The protocol knows the
/// meaning of the bytes.
class SharedSimulation : public tutoring::ReliablePayload {
 public:
  /// Whether both sides know that the pass that was completed left them the same world, or have
  /// said how it differs; the pass lasts until then. Servo thread.
  virtual bool settled() const noexcept = 0;
  /// Whether, on a simulated clock, the session's thread has to empty the protocol's own logs.
  virtual bool wants_attention() const noexcept = 0;
};

}  // namespace haptrial::protocols
