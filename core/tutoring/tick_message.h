#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace haptrial::tutoring {

/// Bytes of a length that is not known before, without memory of their own elsewhere.
/// @tparam kMost  the longest
template <class Byte, std::size_t kMost>
class Packet {
 public:
  static constexpr std::size_t kMostBytes = kMost;
  Packet() = default;
  explicit Packet(std::size_t size) noexcept : size_(size) {}
  void resize(std::size_t size) noexcept { size_ = size; }  // at most kMost
  Byte* data() noexcept { return bytes_.data(); }
  const Byte* data() const noexcept { return bytes_.data(); }
  std::size_t size() const noexcept { return size_; }
  Byte* begin() noexcept { return data(); }
  Byte* end() noexcept { return data() + size_; }
  const Byte* begin() const noexcept { return data(); }
  const Byte* end() const noexcept { return data() + size_; }
  Byte& operator[](std::size_t i) noexcept { return bytes_[i]; }
  const Byte& operator[](std::size_t i) const noexcept { return bytes_[i]; }

 private:
  std::array<Byte, kMost> bytes_{};
  std::size_t size_{0};
};

/// How far a side is with its pass.
enum class TurnPhase : std::uint8_t {
  kNone,    // it has had none yet
  kReady,   // waits for the other side
  kRuns,    //
  kDone,    // completed; the other side may still be at it
  kBroken,  // aborted
};

/// Which pass the sender is at (tutoring::PassBarrier).
struct TurnState {
  std::uint32_t pass{0};  // number since the link began, from 1; 0: none yet
  std::uint32_t with{0};  // the other side's that goes with it; 0: not known yet
  std::uint32_t item{0};  // what it presents, in ascending order: 16 for each trial, and the phase
  TurnPhase phase{TurnPhase::kNone};
  std::uint8_t last_done{0};  // 1: the pass before was completed

  bool operator==(const TurnState&) const = default;
};

/// A message's part of a stream that may lose nothing (tutoring::ReliableStream).
struct StreamPart {
  static constexpr std::size_t kMost = 192;     // bytes of a chunk
  static constexpr std::size_t kBeyond = 1024;  // chunks that may come while one is missing

  std::uint64_t number{0};  // of the chunk, from 1; 0: there is none in the message
  std::uint64_t heard{0};   // all chunks of the other side up to this one have come
  std::array<std::uint64_t, kBeyond / 64> beyond{};  // bit i: chunk heard + 1 + i has come, too
  std::uint16_t size{0};
  std::array<std::byte, kMost> bytes{};

  bool operator==(const StreamPart&) const = default;
};

/// Message of one side of a shared session to the other about a tick.
struct TickMessage {
  std::uint64_t sequence{0};  // from 1, one more each message
  std::int64_t sent_ns{0};    // clock of the sender
  std::int64_t echo_ns{0};    // sent_ns of the newest message that the sender had heard; 0: none
  std::int64_t held_ns{0};    // since it heard that
  Eigen::Vector3d position{Eigen::Vector3d::Zero()};  // of the tool, in W [m]
  Eigen::Vector3d velocity{Eigen::Vector3d::Zero()};  // [m/s]
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};     // of its world on its tool, in W [N]
  Eigen::Vector3d stimulus{Eigen::Vector3d::Zero()};  // of that force (ForceIntent::stimulus) [N]
  double energy{0.0};                                 // EnergyTank::sent() [J]
  double lead{0.0};                                   // the sender's authority, 0 to 1
  std::uint64_t world{0};                             // checksum of what both work on; 0: none
  std::uint32_t buttons{0};
  std::uint32_t flags{0};  // TickFlag
  TurnState turn;
  StreamPart stream;

  bool operator==(const TickMessage&) const = default;
};

enum TickFlag : std::uint32_t {
  kEngaged = 1,  // the sender's coupling is on
  kStop = 2,     // stop, both of you
  kFault = 4,    // the sender's device has one
  kClaim = 8,    // the sender takes the lead, whoever else has it
  kOver = 16,    // the sender has presented all its trials
  kLeft = 32,    // the sender's session ends with trials left
};

/// Length of a message without a stream, and with one.
inline constexpr std::size_t kTickBytes = 4 * 8 + 4 * 3 * 8 + 3 * 8 + 2 * 4 + 3 * 4 + 2;
inline constexpr std::size_t kStreamTickBytes =
    kTickBytes + 2 * 8 + StreamPart::kBeyond / 8 + 2 + StreamPart::kMost;
using TickBytes = Packet<std::byte, kStreamTickBytes>;

/// Little-endian, in the order of the members, without gaps; the stream only where one has begun.
/// Servo thread.
TickBytes encode(const TickMessage& message) noexcept;
/// @returns nothing for another length, a number that is not finite or a flag that is not known.
/// Servo thread.
std::optional<TickMessage> decode(std::span<const std::byte> bytes) noexcept;

}  // namespace haptrial::tutoring
