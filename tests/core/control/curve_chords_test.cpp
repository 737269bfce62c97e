#include "core/control/curve_chords.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/random.h"

namespace haptrial::control {
namespace {

/// Chords of all sizes; some are points, some nodes are missing.
ChordPack random_pack(RandomStream& random) {
  ChordPack pack{};
  const double size = std::pow(10.0, random.uniform(-6.0, 3.0));
  for (std::size_t c = 0; c <= kRun; ++c) {
    const bool same = c > 0 && random.uniform() < 0.1;
    pack.x[c] = same ? pack.x[c - 1] : size * random.normal();
    pack.y[c] = same ? pack.y[c - 1] : size * random.normal();
    pack.z[c] = same ? pack.z[c - 1] : size * random.normal();
    pack.arc[c] = (c > 0 ? pack.arc[c - 1] : 0.0) + size * random.uniform();
  }
  for (double& stray : pack.stray) {
    stray =
        random.uniform() < 0.1 ? std::numeric_limits<double>::quiet_NaN() : size * random.uniform();
  }
  return pack;
}

ChordQuery random_query(const ChordPack& pack, RandomStream& random) {
  const auto arc = [&] { return pack.arc[kRun] * random.uniform(-0.2, 1.2); };
  const double low = arc();
  const double known = arc();
  return {pack.x[0] * random.normal(), pack.y[1] * random.normal(),
          pack.z[2] * random.normal(), low,
          low + std::abs(arc()),       known,
          known + std::abs(arc()),     std::abs(pack.x[3]) * random.uniform(0.0, 3.0)};
}

TEST(CurveChordsTest, OpensTheNodesThatTheDefinitionNames) {
  RandomStream random(12, "nodes");
  for (int trial = 0; trial < 20'000; ++trial) {
    const ChordPack pack = random_pack(random);
    const ChordQuery query = random_query(pack, random);
    ChordLooks looks;
    const unsigned open = scan_chords(pack, query, looks);
    for (std::size_t c = 0; c < kRun; ++c) {
      const double least = std::sqrt(looks.square[c]) - pack.stray[c];
      const bool in_window = pack.arc[c] <= query.high && pack.arc[c + 1] >= query.low;
      const bool known = pack.arc[c] >= query.known_low && pack.arc[c + 1] <= query.known_high;
      const bool wanted = in_window && !known && least <= query.bound;
      if (std::abs(least - query.bound) > 1e-9 * (query.bound + std::sqrt(looks.square[c]))) {
        EXPECT_EQ((open >> c & 1U) != 0, wanted) << trial << " " << c;
      }
    }
  }
}

}  // namespace
}  // namespace haptrial::control
