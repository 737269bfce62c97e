#include "protocols/bone_drilling/shared_bone.h"

#include <fmt/format.h>

#include <algorithm>

namespace haptrial::protocols {
namespace {

/// Ticks that may wait: half a minute at 1 kHz, longer than a link may be silent by default.
constexpr std::size_t kMostWaiting = 32768;

}  // namespace

SharedBone::SharedBone(bool leads)
    : leads_(leads), outbox_(leads ? kMostWaiting : 4), inbox_(leads ? 4 : kMostWaiting) {}

void SharedBone::take_new_bone(std::uint64_t checksum) noexcept {
  bone_ = leads_ ? bone_ + 1 : 0;
  new_bone_ = checksum;
  witness_ = 0;
  difference_told_ = false;
  step_is_done_ = false;
  steps_.store(0, std::memory_order_relaxed);
  differs_at_.store(0, std::memory_order_relaxed);
  new_differs_.store(false, std::memory_order_relaxed);
  no_room_.store(false, std::memory_order_relaxed);
  needs_new_bone_.store(false, std::memory_order_relaxed);
}

void SharedBone::prepare_pass(std::int32_t trial) noexcept {
  trial_ = trial;
  completed_.store(false, std::memory_order_relaxed);
  own_known_.store(false, std::memory_order_relaxed);
  told_.store(false, std::memory_order_relaxed);
}

void SharedBone::put(const BoneParcel& parcel) noexcept {
  if (!outbox_.push(parcel)) {
    no_room_.store(true, std::memory_order_relaxed);
  }
}

void SharedBone::tell_begin() noexcept {
  their_known_.store(false, std::memory_order_relaxed);
  sum_given_ = false;
  put(parcel_of(BoneBegin{++pass_, trial_, bone_, new_bone_}));
}

void SharedBone::tell_step(const device::DeviceReading& recorded,
                           const bone::Simulator& simulator) noexcept {
  using Kind = bone::WorldEvent::Kind;
  for (const bone::WorldEvent& event : simulator.separations()) {
    if (event.kind == Kind::kBorn) {
      std::span<const bone::Voxel> seeds = simulator.world().seeds(event.piece);
      for (; !seeds.empty(); seeds = seeds.subspan(std::min(seeds.size(), kMostSeeds))) {
        put(parcel_of_split(event.parent, event.piece, seeds));
      }
    } else if (event.kind == Kind::kCrumb) {
      put(parcel_of_split(event.piece, -1, {&event.seed, 1}));
    }
  }
  witness_ = witness_after(witness_, simulator);
  steps_.fetch_add(1, std::memory_order_relaxed);
  put(parcel_of(BoneStep{recorded, static_cast<std::uint32_t>(witness_)}));
}

void SharedBone::tell_end() noexcept {
  put(parcel_of_end());
  completed_.store(true, std::memory_order_release);
}

bool SharedBone::reach(const BoneBegin& begin) noexcept {
  if (begin.trial == trial_) {
    if (bone_ != 0 && begin.bone != bone_) {
      needs_new_bone_.store(true, std::memory_order_relaxed);
      return false;
    }
    bone_ = begin.bone;
    if (begin.new_bone != new_bone_) {
      new_differs_.store(true, std::memory_order_relaxed);
    }
  }
  reached_ = begin;
  return true;
}

std::uint64_t SharedBone::followed(const BoneStep& step,
                                   const bone::Simulator& simulator) noexcept {
  witness_ = witness_after(witness_, simulator);
  const std::uint64_t number = steps_.fetch_add(1, std::memory_order_relaxed) + 1;
  if (static_cast<std::uint32_t>(witness_) != step.witness &&
      differs_at_.load(std::memory_order_relaxed) == 0) {
    differs_at_.store(number, std::memory_order_relaxed);
  }
  return number;
}

/// Gives as many parcels as fit, each with its length before it.
std::size_t SharedBone::give(std::span<std::byte> room) noexcept {
  std::size_t used = 0;
  const auto add = [&](const BoneParcel& parcel) {
    if (used + 1 + parcel.size() > room.size()) {
      return false;
    }
    room[used] = static_cast<std::byte>(parcel.size());
    std::copy(parcel.begin(), parcel.end(), room.begin() + static_cast<std::ptrdiff_t>(used) + 1);
    used += 1 + parcel.size();
    return true;
  };
  while (outbox_.size() > 0 && add(outbox_.at(0))) {
    outbox_.pop();
  }
  if (outbox_.size() == 0 && !sum_given_ && own_known_.load(std::memory_order_acquire)) {
    const std::int32_t pass = leads_ ? pass_ : reached_.pass;
    sum_given_ = add(parcel_of(BoneSum{pass, own_sum_.load(std::memory_order_relaxed)}));
  }
  return used;
}

void SharedBone::take(std::span<const std::byte> bytes) noexcept {
  while (!bytes.empty()) {
    const auto size = static_cast<std::size_t>(bytes.front());
    bytes = bytes.subspan(1);
    if (size == 0 || size > bytes.size() || size > BoneParcel::kMostBytes) {
      return;
    }
    BoneParcel parcel(size);
    std::copy_n(bytes.begin(), size, parcel.begin());
    bytes = bytes.subspan(size);
    accept(parcel);
  }
}

/// A checksum waits for nothing: it is of the pass that came last, or of none.
void SharedBone::accept(const BoneParcel& parcel) noexcept {
  const BoneParcelKind kind = kind_of(parcel);
  if (kind == BoneParcelKind::kChecksum) {
    const BoneSum sum = sum_of(parcel);
    if (sum.pass == (leads_ ? pass_ : newest_pass_)) {
      their_sum_.store(sum.checksum, std::memory_order_relaxed);
      their_known_.store(true, std::memory_order_release);
    }
    return;
  }
  if (leads_) {
    return;
  }
  if (kind == BoneParcelKind::kBegin) {
    newest_pass_ = begin_of(parcel).pass;
    their_known_.store(false, std::memory_order_relaxed);
    sum_given_ = false;
  }
  if (!inbox_.push(parcel)) {
    no_room_.store(true, std::memory_order_relaxed);
  }
}

bool SharedBone::wants_attention() const noexcept {
  if (!completed_.load(std::memory_order_acquire) || settled()) {
    return false;
  }
  return !own_known_.load(std::memory_order_acquire) ||
         their_known_.load(std::memory_order_acquire);
}

/// The first one is said, once for a bone.
std::optional<SharedBone::BoneComparison> SharedBone::difference() noexcept {
  if (difference_told_) {
    return std::nullopt;
  }
  BoneComparison told{true, {}};
  if (no_room_.load(std::memory_order_relaxed)) {
    told.text =
        "the bones of the two sides differ: the other side was silent for so long that "
        "there was no room for what it missed";
  } else if (new_differs_.load(std::memory_order_relaxed)) {
    told.text =
        "the bones of the two sides differ from the beginning: their files are not the "
        "same ones";
  } else if (const std::uint64_t at = differs_at_.load(std::memory_order_relaxed); at != 0) {
    told.text = fmt::format(
        "the bones of the two sides differ from tick {} of the drilling on: "
        "something else was removed here than there",
        at);
  } else {
    return std::nullopt;
  }
  difference_told_ = true;
  return told;
}

std::optional<SharedBone::BoneComparison> SharedBone::attend(const bone::Simulator& simulator) {
  if (std::optional<BoneComparison> found = difference()) {
    return found;
  }
  if (!completed_.load(std::memory_order_acquire) || settled()) {
    return std::nullopt;
  }
  if (!own_known_.load(std::memory_order_relaxed)) {
    own_sum_.store(simulator.checksum(), std::memory_order_relaxed);
    own_known_.store(true, std::memory_order_release);
  }
  if (!their_known_.load(std::memory_order_acquire)) {
    return std::nullopt;
  }
  const std::uint64_t own = own_sum_.load(std::memory_order_relaxed);
  const std::uint64_t their = their_sum_.load(std::memory_order_relaxed);
  const std::uint64_t steps = steps_.load(std::memory_order_relaxed);
  told_.store(true, std::memory_order_release);
  return own == their
             ? BoneComparison{false,
                              fmt::format("the bones of both sides are the same after {} ticks of "
                                          "drilling: checksum {:016x}",
                                          steps, own)}
             : BoneComparison{
                   true, fmt::format("the bones of the two sides differ after {} ticks of "
                                     "drilling: the checksum is {:016x} here and {:016x} there",
                                     steps, own, their)};
}

}  // namespace haptrial::protocols
