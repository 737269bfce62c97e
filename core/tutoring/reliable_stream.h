#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/tutoring/tick_message.h"

namespace haptrial::tutoring {

/// Source and receiver of data that must not be lost. Servo thread.
class ReliablePayload {
 public:
  virtual ~ReliablePayload() = default;
  /// @param room  for what comes next
  /// @returns how many of its bytes were used; 0: there is nothing, or it does not fit
  virtual std::size_t give(std::span<std::byte> room) noexcept = 0;
  /// Receives the bytes that one give() of the other side wrote: each once, in their order.
  virtual void take(std::span<const std::byte> bytes) noexcept = 0;
};

/// Brings what must not be lost to the other side, once and in its order, within messages any of
/// which may be lost, come twice or overtake another: chunks are numbered, the other side says
/// which have come, and what is missing is sent again. A message has one chunk at most. Servo
/// thread: no allocation, lock, I/O or throw after the constructor.
class ReliableStream {
 public:
  ReliableStream();

  /// Takes the stream's part of a message that came.
  void hear(const StreamPart& part) noexcept;
  /// Hands over what has come, as far as nothing is missing before it.
  void deliver(ReliablePayload& payload) noexcept;

  /// Looks whether a message is needed now. @param round_trip_ns  negative: not known
  bool wants(ReliablePayload& payload, std::int64_t now_ns, std::int64_t round_trip_ns) noexcept;
  /// Fills the stream's part of a message that leaves in the same tick.
  void fill(StreamPart& part, std::int64_t now_ns) noexcept;

  /// Whether the other side has all that was given so far.
  bool all_heard() const noexcept { return heard_ == given_; }
  std::uint64_t given() const noexcept { return given_; }  // chunks
  std::uint64_t again() const noexcept { return again_; }  // chunks that were sent once more

 private:
  static constexpr std::uint64_t kSpan = StreamPart::kBeyond;  // chunks under way at once
  struct Chunk {
    std::uint16_t size{0};
    std::array<std::byte, StreamPart::kMost> bytes{};
  };
  struct SentChunk {
    Chunk chunk;
    std::int64_t sent_ns{0};
    bool heard{false};
  };
  struct ReceivedChunk {
    Chunk chunk;
    bool here{false};
  };
  static std::size_t slot(std::uint64_t number) noexcept {
    return static_cast<std::size_t>(number % kSpan);
  }
  void note_heard(std::uint64_t number) noexcept;
  std::uint64_t missing(std::int64_t now_ns, std::int64_t round_trip_ns) const noexcept;
  std::uint64_t next(ReliablePayload& payload) noexcept;

  std::vector<SentChunk> out_;    // at number % kSpan
  std::uint64_t given_{0};        // chunks so far
  std::uint64_t heard_{0};        // all up to here have come there
  std::int64_t newest_heard_{0};  // when the latest of those that have come was sent [ns]
  std::uint64_t chosen_{0};       // for this tick's message; 0: none
  std::uint64_t again_{0};

  std::vector<ReceivedChunk> in_;
  std::uint64_t taken_{0};  // all up to here were handed over
  bool answer_due_{false};  // something has come that the other side does not know of
};

}  // namespace haptrial::tutoring
