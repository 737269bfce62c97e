#pragma once

#include <filesystem>

#include "core/realtime/servo_loop.h"

namespace haptrial::test {

/// Result of a real-clock session of a fixed length.
struct TimedSession {
  std::uint64_t ticks{0};
  std::uint64_t overruns{0};
  std::uint64_t dropped{0};
  double seconds{0.0};  // on the wall
  realtime::LoopTiming timing;
  realtime::RealTimeStatus status;
};

/// Runs the shipped study's passes with a virtual subject on the real clock for `ticks` periods and
/// records them into `file`, the recorder on a thread of its own.
TimedSession run_timed_session(std::uint64_t ticks, const std::filesystem::path& file);

}  // namespace haptrial::test
