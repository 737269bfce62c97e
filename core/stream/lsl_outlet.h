#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/record/rows/session_types.h"
#include "core/stream/side_stream.h"

namespace haptrial::stream {

/// Names and descriptions of the streams.
struct LslOptions {
  std::string library{"liblsl.so"};  // a name that the loader searches for, or a path
  std::string study;                 // name of the experiment
  std::string subject;               // identifier
  std::string device;
  double rate{1000.0};  // of the samples [Hz]
  bool simulated{false};
  std::vector<SideStream> sides{};  // beside the samples; their `read` is not used
};

/// The session's time now, since its first tick: the clock of record::Sample::time_ns [ns].
using SessionClock = std::function<std::int64_t()>;

/// Sends a session to the Lab Streaming Layer while it runs: every sample in one stream, markers in
/// another, on the layer's own clock, so that an EEG or eye tracker can be put beside it. The
/// layer's library is loaded at run time.
///
/// A push may wait for a lock: everything belongs to the threads that empty logs, which may call at
/// the same time, never to the servo thread.
///
/// Streams: "haptrial SUBJECT" of type Haptics, double precision, one channel a column of
/// channels(); "haptrial SUBJECT markers" of type Markers, one text a marker; for each side stream
/// "haptrial SUBJECT NAME" of its type, double precision.
class LslOutlet {
 public:
  struct Channel {
    const char* label;
    const char* unit;
    const char* type;
  };
  static std::span<const Channel> channels();

  /// @throws InputError when the library is absent or lacks a function.
  static void check_library(const std::string& library = LslOptions{}.library);

  /// @param now  of the session; asked by the thread that pushes, from time to time
  /// @throws InputError as check_library() does; RunError when the library refuses a stream.
  LslOutlet(const LslOptions& options, SessionClock now);
  ~LslOutlet();
  LslOutlet(const LslOutlet&) = delete;
  LslOutlet& operator=(const LslOutlet&) = delete;

  /// An outlet where there can be one; else none and a sentence in `notice`: a session goes on
  /// without its streams.
  static std::unique_ptr<LslOutlet> open(const LslOptions& options, SessionClock now,
                                         std::string& notice);

  /// Times are given to the layer on its own clock. How far that is from the session's is measured
  /// at the first push, then every second, and for each marker.
  void push(std::span<const record::Sample> samples);
  /// Samples of a side stream. @param number  of LslOptions::sides; another one: nothing is sent
  /// @param values  (samples x channels)  @param times  on the session's clock [s]
  void push_side(std::size_t number, std::span<const double> values, std::span<const double> times);
  /// @returns whether the library took it
  bool mark(const std::string& text, std::int64_t session_ns);

  /// Samples and markers that the library did not take, and its words for the first one.
  std::uint64_t refused() const;
  std::string first_refusal() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace haptrial::stream
