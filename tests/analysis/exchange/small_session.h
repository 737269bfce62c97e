#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/record/rows/device_rows.h"
#include "core/record/rows/session_types.h"

namespace haptrial::exchange {

/// A session of a few seconds whose contents are known.
struct SmallSession {
  std::string subject{"P01"};
  std::uint64_t session{1};
  bool simulated{true};
  std::string clock{"simulated"};
  double rate{500.0};  // [Hz]
  std::string start_utc{"2026-11-20T09:30:00Z"};
  std::string definition{"name = \"small\"\n"};
  record::Participant person{};
  int trials{3};                // a condition each
  std::uint64_t first_tick{0};  // sequence number of the first sample
  std::uint64_t gap_at{0};      // samples before the gap; 0: no gap
  std::uint64_t gap{0};         // ticks that are missing there
  std::uint64_t late_at{0};     // samples before the loop was suspended; 0: never
  std::int64_t late_ns{0};      // how long it was
  bool odd_values{false};       // an applied force that is not a number
  std::string note{"all is well"};
  bool pilot{false};
  int practice{0};          // trials of practice before the first
  int ticks_of_no_pass{0};  // samples before the first pass, as a recovered session may have
  int other_devices{0};     // after the first; the last tick of each pass is of the first alone
};

constexpr int kTicksOfPass = 1000;

void write_session(const std::filesystem::path& file, const SmallSession& session);

/// Row of another device in a tick. @param device  from 1
record::DeviceRow small_device(const record::Sample& sample, int device);

/// Applied and target force of trial `trial` from 1, tick `k` of its run [N].
double small_target(int trial, int k);
double small_applied(int trial, int k);

}  // namespace haptrial::exchange
