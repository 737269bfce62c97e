#include "protocols/bone_drilling/bone_parcels.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace haptrial::protocols {
namespace {

/// Writes one number after the other. Readings lie on the grids of the file, which keeps them as
/// float.
class ParcelWriter {
 public:
  explicit ParcelWriter(BoneParcelKind kind) noexcept { put(static_cast<std::uint8_t>(kind)); }
  template <class T>
  void put(T value) noexcept {
    std::memcpy(parcel_.data() + size_, &value, sizeof(value));
    size_ += sizeof(value);
  }
  void put_all(std::span<const double> values) noexcept {
    std::for_each(values.begin(), values.end(),
                  [this](double value) { put(static_cast<float>(value)); });
  }
  BoneParcel done() noexcept {
    parcel_.resize(size_);
    return parcel_;
  }

 private:
  BoneParcel parcel_;
  std::size_t size_{0};
};

class ParcelReader {
 public:
  explicit ParcelReader(const BoneParcel& parcel) noexcept : parcel_(parcel) {}
  template <class T>
  T get() noexcept {
    T value{};
    if (at_ + sizeof(value) <= parcel_.size()) {
      std::memcpy(&value, parcel_.data() + at_, sizeof(value));
    }
    at_ += sizeof(value);
    return value;
  }
  void get_all(std::span<double> values) noexcept {
    std::for_each(values.begin(), values.end(),
                  [this](double& value) { value = static_cast<double>(get<float>()); });
  }

 private:
  const BoneParcel& parcel_;
  std::size_t at_{1};
};

std::uint64_t mixed_in(std::uint64_t sum, std::uint64_t more) noexcept {
  std::uint64_t x = (sum ^ more) * 0x9E3779B97F4A7C15U;  // of SplitMix64
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9U;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBU;
  return x ^ (x >> 31);
}

std::uint64_t word_of(int piece, const bone::Voxel& voxel) noexcept {
  constexpr unsigned kBits = 16;
  std::uint64_t word = static_cast<std::uint64_t>(piece) & 0xFFFFU;
  for (int axis = 0; axis < 3; ++axis) {
    word = word << kBits | (static_cast<std::uint64_t>(voxel[axis]) & 0xFFFFU);
  }
  return word;
}

}  // namespace

BoneParcelKind kind_of(const BoneParcel& parcel) noexcept {
  return parcel.size() == 0 ? BoneParcelKind{0}
                            : static_cast<BoneParcelKind>(static_cast<std::uint8_t>(parcel[0]));
}

BoneParcel parcel_of(const BoneBegin& begin) noexcept {
  ParcelWriter out(BoneParcelKind::kBegin);
  out.put(begin.pass);
  out.put(begin.trial);
  out.put(begin.bone);
  out.put(begin.new_bone);
  return out.done();
}

BoneBegin begin_of(const BoneParcel& parcel) noexcept {
  ParcelReader in(parcel);
  BoneBegin begin;
  begin.pass = in.get<std::int32_t>();
  begin.trial = in.get<std::int32_t>();
  begin.bone = in.get<std::int32_t>();
  begin.new_bone = in.get<std::uint64_t>();
  return begin;
}

BoneParcel parcel_of(const BoneStep& step) noexcept {
  const device::DeviceReading& r = step.reading;
  ParcelWriter out(BoneParcelKind::kStep);
  out.put_all({r.tool.position.data(), 3});
  out.put_all({r.tool.velocity.data(), 3});
  out.put_all({r.orientation.coeffs().data(), 4});
  out.put_all({&r.pedal, 1});
  out.put(r.buttons);
  out.put(r.keys);
  out.put(step.witness);
  return out.done();
}

BoneStep step_of(const BoneParcel& parcel) noexcept {
  ParcelReader in(parcel);
  BoneStep step;
  device::DeviceReading& r = step.reading;
  in.get_all({r.tool.position.data(), 3});
  in.get_all({r.tool.velocity.data(), 3});
  in.get_all({r.orientation.coeffs().data(), 4});
  in.get_all({&r.pedal, 1});
  r.buttons = in.get<std::uint32_t>();
  r.keys = in.get<std::uint32_t>();
  step.witness = in.get<std::uint32_t>();
  return step;
}

BoneParcel parcel_of_end() noexcept { return ParcelWriter(BoneParcelKind::kEnd).done(); }

BoneParcel parcel_of(const BoneSum& sum) noexcept {
  ParcelWriter out(BoneParcelKind::kChecksum);
  out.put(sum.pass);
  out.put(sum.checksum);
  return out.done();
}

BoneSum sum_of(const BoneParcel& parcel) noexcept {
  ParcelReader in(parcel);
  BoneSum sum;
  sum.pass = in.get<std::int32_t>();
  sum.checksum = in.get<std::uint64_t>();
  return sum;
}

BoneParcel parcel_of_split(int from, int to, std::span<const bone::Voxel> seeds) noexcept {
  ParcelWriter out(BoneParcelKind::kSplit);
  const std::size_t count = std::min(seeds.size(), kMostSeeds);
  out.put(static_cast<std::int32_t>(from));
  out.put(static_cast<std::int32_t>(to));
  out.put(static_cast<std::uint8_t>(count));
  for (const bone::Voxel& seed : seeds.first(count)) {
    out.put(std::array<std::int32_t, 3>{seed.x(), seed.y(), seed.z()});
  }
  return out.done();
}

void add_split(const BoneParcel& parcel, std::vector<bone::RecordedSplit>& splits) {
  ParcelReader in(parcel);
  const auto from = in.get<std::int32_t>();
  const auto to = in.get<std::int32_t>();
  const auto count = in.get<std::uint8_t>();
  if (to < 0 || splits.empty() || splits.back().to != to) {
    splits.push_back({from, to, {}});
  }
  for (std::uint8_t i = 0; i < count && i < kMostSeeds; ++i) {
    const auto seed = in.get<std::array<std::int32_t, 3>>();
    splits.back().seeds.emplace_back(seed[0], seed[1], seed[2]);
  }
}

std::uint64_t witness_after(std::uint64_t before, const bone::Simulator& simulator) noexcept {
  const bone::SimulatorOutput& out = simulator.output();
  std::uint64_t sum = before;
  if (out.removed != 0.0 || out.cut != 0.0) {
    sum = mixed_in(sum, std::bit_cast<std::uint64_t>(out.removed));
    sum = mixed_in(sum, std::bit_cast<std::uint64_t>(out.cut));
  }
  for (const bone::EmptiedIn& gone : simulator.emptied()) {
    sum = mixed_in(sum, word_of(gone.piece, gone.voxel));
  }
  for (const bone::WorldEvent& event : simulator.separations()) {
    if (event.kind != bone::WorldEvent::Kind::kNoRoom) {
      sum = mixed_in(sum, std::bit_cast<std::uint64_t>(event.amount));
    }
  }
  return sum;
}

bool BoneParcels::push(const BoneParcel& parcel) noexcept {
  if (size() == parcels_.size()) {
    return false;
  }
  parcels_[static_cast<std::size_t>(pushed_ % parcels_.size())] = parcel;
  ++pushed_;
  return true;
}

}  // namespace haptrial::protocols
