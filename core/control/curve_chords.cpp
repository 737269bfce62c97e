#include "core/control/curve_chords.h"

#include <cstring>

namespace haptrial::control {
namespace {

constexpr std::size_t kLanes = 2;                                  // that every processor has
typedef long long Flags __attribute__((vector_size(8 * kLanes)));  // -1 or 0
typedef double Lanes __attribute__((vector_size(8 * kLanes)));

inline Lanes load(const double* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

/// The squared distance to the chords from `first` on.
inline Lanes look(const Chords& s, const ChordQuery& query, std::size_t first, ChordLooks& looks) {
  const Lanes x = load(s.x + first);
  const Lanes y = load(s.y + first);
  const Lanes z = load(s.z + first);
  const Lanes dx = load(s.x + first + 1) - x;
  const Lanes dy = load(s.y + first + 1) - y;
  const Lanes dz = load(s.z + first + 1) - z;
  const Lanes ax = query.x - x;
  const Lanes ay = query.y - y;
  const Lanes az = query.z - z;
  const Lanes zero = {};
  const Lanes one = zero + 1.0;
  // 0 / 0 of a point is not above 0, and so 0.
  Lanes t = (ax * dx + ay * dy + az * dz) / (dx * dx + dy * dy + dz * dz);
  t = t > zero ? t : zero;
  t = t < one ? t : one;
  const Lanes ex = ax - t * dx;
  const Lanes ey = ay - t * dy;
  const Lanes ez = az - t * dz;
  const Lanes square = ex * ex + ey * ey + ez * ez;
  std::memcpy(looks.along + first, &t, sizeof t);
  std::memcpy(looks.square + first, &square, sizeof square);
  return square;
}

inline unsigned bits_of(Flags flags) {
  return static_cast<unsigned>(flags[0] & 1) | static_cast<unsigned>(flags[1] & 2);
}

}  // namespace

void measure_chords(const Chords& chords, const ChordQuery& query, ChordLooks& looks) {
  for (std::size_t first = 0; first < kRun; first += kLanes) {
    look(chords, query, first, looks);
  }
}

unsigned scan_chords(const ChordPack& pack, const ChordQuery& query, ChordLooks& looks) {
  unsigned open = 0;
  for (std::size_t first = 0; first < kRun; first += kLanes) {
    const Lanes square = look(pack, query, first, looks);
    const Lanes far = query.bound + load(pack.stray + first);
    const Lanes begin = load(pack.arc + first);
    const Lanes end = load(pack.arc + first + 1);
    const Flags near = square <= far * far * (1.0 + kChordRounding);  // not where there is no node
    const Flags wanted = (begin <= query.high) & (end >= query.low);
    const Flags known = (begin >= query.known_low) & (end <= query.known_high);
    const Flags flags = near & wanted & ~known;
    open |= bits_of(flags) << first;
  }
  return open;
}

}  // namespace haptrial::control
