#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/bone/simulator/simulator.h"
#include "core/device/device.h"
#include "core/tutoring/tick_message.h"

namespace haptrial::protocols {

/// Kind of a parcel that the side that owns the bone sends to the other; within a stream of which
/// nothing is lost (tutoring::ReliableStream). The first byte of a parcel says which of these it
/// is.
enum class BoneParcelKind : std::uint8_t {
  kBegin = 1,  // a pass
  kSplit,      // a part was separated on the tick whose kStep comes next
  kStep,       // a tick
  kEnd,        // the pass is completed
  kChecksum,   // of the bone, at the end of a pass; also told back
};

using BoneParcel = tutoring::Packet<std::byte, 184>;

struct BoneBegin {
  std::int32_t pass{0};  // of the side that tells, since the link began, from 1
  std::int32_t trial{0};
  std::int32_t bone{0};       // that is drilled, since the link began, from 1
  std::uint64_t new_bone{0};  // checksum of the bone when it was new
};

/// A tick: what the bone does follows from what the device gave, as it is recorded.
struct BoneStep {
  device::DeviceReading reading;  // on the grids of the session file
  std::uint32_t witness{0};       // of all that was done to the bone so far
};

struct BoneSum {
  std::int32_t pass{0};
  std::uint64_t checksum{0};
};

// Servo thread, but for split_of().
BoneParcelKind kind_of(const BoneParcel& parcel) noexcept;
BoneParcel parcel_of(const BoneBegin& begin) noexcept;
BoneParcel parcel_of(const BoneStep& step) noexcept;
BoneParcel parcel_of_end() noexcept;
BoneParcel parcel_of(const BoneSum& sum) noexcept;
/// @param seeds  those that do not fit into one parcel go into the next one; kMostSeeds at most
BoneParcel parcel_of_split(int from, int to, std::span<const bone::Voxel> seeds) noexcept;
inline constexpr std::size_t kMostSeeds = 14;  // of a parcel
BoneBegin begin_of(const BoneParcel& parcel) noexcept;
BoneStep step_of(const BoneParcel& parcel) noexcept;
BoneSum sum_of(const BoneParcel& parcel) noexcept;
/// Adds what a kSplit says. Allocates.
void add_split(const BoneParcel& parcel, std::vector<bone::RecordedSplit>& splits);

/// Witness of a bone after a tick of its simulator, from the witness before: a different number if
/// anything else was done to the bone. Servo thread.
std::uint64_t witness_after(std::uint64_t before, const bone::Simulator& simulator) noexcept;

/// Parcels that wait, in their order, without memory of their own elsewhere after the constructor.
/// Servo thread.
class BoneParcels {
 public:
  explicit BoneParcels(std::size_t most) : parcels_(most) {}
  /// @returns whether there was room.
  bool push(const BoneParcel& parcel) noexcept;
  std::size_t size() const noexcept { return static_cast<std::size_t>(pushed_ - popped_); }
  /// @param i  below size(); another thread may read while none is popped
  const BoneParcel& at(std::size_t i) const noexcept {
    return parcels_[static_cast<std::size_t>((popped_ + i) % parcels_.size())];
  }
  void pop(std::size_t count = 1) noexcept { popped_ += count; }

 private:
  std::vector<BoneParcel> parcels_;
  std::uint64_t pushed_{0};
  std::uint64_t popped_{0};
};

}  // namespace haptrial::protocols
