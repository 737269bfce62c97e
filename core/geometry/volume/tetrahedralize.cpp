#include "core/geometry/volume/tetrahedralize.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <span>

#include "core/base/error.h"

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace haptrial::geometry {
namespace {

using Word = std::uint64_t;
constexpr std::size_t kWordBits = 64;
constexpr std::size_t kPerVoxel = 5;

/// The split by the parity of i + j + k; corner x + 2 y + 4 z.
constexpr std::array<std::array<std::array<int, 4>, kPerVoxel>, 2> kSplits{
    {{{{0, 5, 3, 6}, {1, 3, 0, 5}, {2, 0, 3, 6}, {4, 5, 0, 6}, {7, 3, 5, 6}}},
     {{{1, 4, 7, 2}, {0, 2, 4, 1}, {3, 1, 7, 2}, {5, 4, 7, 1}, {6, 2, 7, 4}}}}};

/// Eight labels in eight bits, 1 where the label is kInside.
Word inside_bits(const VoxelLabel* labels) {
  static_assert(static_cast<int>(VoxelLabel::kInside) == 1 &&
                (static_cast<int>(VoxelLabel::kBorder) & 1) == 0);
  Word bytes = 0;
  std::memcpy(&bytes, labels, sizeof bytes);
  constexpr Word kLowest = 0x0101010101010101;
  constexpr Word kGather = 0x0102040810204080;
  return (bytes & kLowest) * kGather >> 56;
}

/// The corner points of the voxels, row by row along x: which of them a voxel uses, and their
/// numbers.
class CornerNumbers {
 public:
  explicit CornerNumbers(const VoxelSolid& solid)
      : size_(solid.grid.size),
        words_((static_cast<std::size_t>(size_[0]) + 1 + kWordBits - 1) / kWordBits),
        voxels_(words_ * static_cast<std::size_t>(size_[1]) * static_cast<std::size_t>(size_[2])),
        nothing_(words_, 0) {
    pack(solid);
    count();
  }

  std::size_t vertices() const { return vertices_; }
  std::size_t inside() const { return inside_; }
  std::size_t words() const { return words_; }

  /// Bits of a row of voxels; all 0 where there is none.
  std::span<const Word> voxel_row(std::int32_t j, std::int32_t k) const {
    const bool there = j >= 0 && j < size_[1] && k >= 0 && k < size_[2];
    return there ? std::span(voxels_).subspan(words_ * voxel_row_number(j, k), words_)
                 : std::span(nothing_);
  }
  /// Bits of a row of corner points, 0 <= j <= size y, 0 <= k <= size z.
  std::span<const Word> used_row(std::int32_t j, std::int32_t k) const {
    return std::span(used_).subspan(words_ * corner_row_number(j, k), words_);
  }
  /// The number of a used corner point.
  std::int32_t number(std::size_t i, std::int32_t j, std::int32_t k) const {
    const std::size_t word = words_ * corner_row_number(j, k) + i / kWordBits;
    const Word below = (Word{1} << i % kWordBits) - 1;
    return static_cast<std::int32_t>(numbers_[word] + std::popcount(used_[word] & below));
  }

 private:
  std::size_t voxel_row_number(std::int32_t j, std::int32_t k) const {
    return static_cast<std::size_t>(j) +
           static_cast<std::size_t>(size_[1]) * static_cast<std::size_t>(k);
  }
  std::size_t corner_row_number(std::int32_t j, std::int32_t k) const {
    return static_cast<std::size_t>(j) +
           (static_cast<std::size_t>(size_[1]) + 1) * static_cast<std::size_t>(k);
  }

  void pack(const VoxelSolid& solid) {
    const auto length = static_cast<std::size_t>(size_[0]);
    for (std::size_t row = 0; row * words_ < voxels_.size(); ++row) {
      const VoxelLabel* labels = solid.labels.data() + length * row;
      Word* bits = voxels_.data() + words_ * row;
      std::size_t i = 0;
      for (; i + 8 <= length; i += 8) {
        bits[i / kWordBits] |= inside_bits(labels + i) << i % kWordBits;
      }
      for (; i < length; ++i) {
        bits[i / kWordBits] |= Word{labels[i] == VoxelLabel::kInside} << i % kWordBits;
      }
      for (std::size_t w = 0; w < words_; ++w) {
        inside_ += static_cast<std::size_t>(std::popcount(bits[w]));
      }
    }
  }

  void count() {
    const std::size_t rows =
        (static_cast<std::size_t>(size_[1]) + 1) * (static_cast<std::size_t>(size_[2]) + 1);
    used_.resize(words_ * rows);
    numbers_.resize(words_ * rows);
    std::size_t at = 0;
    for (std::int32_t k = 0; k <= size_[2]; ++k) {
      for (std::int32_t j = 0; j <= size_[1]; ++j) {
        const auto a = voxel_row(j - 1, k - 1);
        const auto b = voxel_row(j, k - 1);
        const auto c = voxel_row(j - 1, k);
        const auto d = voxel_row(j, k);
        Word carried = 0;
        for (std::size_t w = 0; w < words_; ++w, ++at) {
          const Word any = a[w] | b[w] | c[w] | d[w];
          used_[at] = any | any << 1 | carried;
          carried = any >> (kWordBits - 1);
          numbers_[at] = static_cast<std::uint32_t>(vertices_);
          vertices_ += static_cast<std::size_t>(std::popcount(used_[at]));
        }
      }
    }
  }

  std::array<std::int32_t, 3> size_;
  std::size_t words_;
  std::vector<Word> voxels_;
  std::vector<Word> nothing_;
  std::vector<Word> used_;
  std::vector<std::uint32_t> numbers_;  // of the first used corner of each word
  std::size_t vertices_{0};
  std::size_t inside_{0};
};

/// Calls take(first, last) for every run of ones, last behind its end.
template <class Take>
void each_run(std::span<const Word> bits, const Take& take) {
  const std::size_t end = bits.size() * kWordBits;
  const auto next = [&](std::size_t from, Word flip) {
    for (std::size_t w = from / kWordBits; w < bits.size(); ++w) {
      const Word open = w == from / kWordBits ? ~Word{0} << from % kWordBits : ~Word{0};
      if (const Word found = (bits[w] ^ flip) & open; found != 0) {
        return w * kWordBits + static_cast<std::size_t>(std::countr_zero(found));
      }
    }
    return end;
  };
  for (std::size_t first = next(0, 0); first < end;) {
    const std::size_t last = next(first, ~Word{0});
    take(first, last);
    first = last < end ? next(last, 0) : end;
  }
}

void write_vertices(const VoxelGrid& grid, const CornerNumbers& corners, TetMesh& mesh) {
  Eigen::Vector3d* vertex = mesh.vertices.data();
  std::uint8_t* on_surface = mesh.on_surface.data();
  for (std::int32_t k = 0; k <= grid.size[2]; ++k) {
    const double z = grid.origin.z() + grid.spacing * (k - 0.5);
    for (std::int32_t j = 0; j <= grid.size[1]; ++j) {
      const double y = grid.origin.y() + grid.spacing * (j - 0.5);
      const auto a = corners.voxel_row(j - 1, k - 1);
      const auto b = corners.voxel_row(j, k - 1);
      const auto c = corners.voxel_row(j - 1, k);
      const auto d = corners.voxel_row(j, k);
      const auto used = corners.used_row(j, k);
      Word carried = 0;
      for (std::size_t w = 0; w < corners.words(); ++w) {
        const Word all = a[w] & b[w] & c[w] & d[w];
        const Word within = all & (all << 1 | carried);  // all eight voxels around are inside
        carried = all >> (kWordBits - 1);
        for (Word left = used[w]; left != 0; left &= left - 1) {
          const auto bit = static_cast<std::size_t>(std::countr_zero(left));
          const auto i = static_cast<double>(w * kWordBits + bit);
          *vertex++ = {grid.origin.x() + grid.spacing * (i - 0.5), y, z};
          *on_surface++ = static_cast<std::uint8_t>((within >> bit & 1) == 0);
        }
      }
    }
  }
}

/// The four corners of a tetrahedron at once.
#ifdef __SSE2__
struct Four {
  explicit Four(const Tetrahedron& numbers)
      : values(_mm_loadu_si128(reinterpret_cast<const __m128i*>(numbers.data()))) {}
  void add(const Four& other) { values = _mm_add_epi32(values, other.values); }
  /// Past the caches: what is written is not read again soon, and a line that is written whole need
  /// not be fetched first.
  void put(Tetrahedron* place) const {
    _mm_stream_si128(reinterpret_cast<__m128i*>(place), values);
  }
  static void end() { _mm_sfence(); }
  __m128i values;
};
#else
struct Four {
  explicit Four(const Tetrahedron& numbers) : values(numbers) {}
  void add(const Four& other) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] += other.values[i];
    }
  }
  void put(Tetrahedron* place) const { *place = values; }
  static void end() {}
  Tetrahedron values;
};
#endif

/// The tetrahedra of a run of voxels. The numbers of their corners rise by one from voxel to voxel
/// in each of the four rows of corner points, because a run uses all points beside it.
/// @param rows  the numbers of the first voxel's corners 0, 2, 4, 6
Tetrahedron* write_run(Tetrahedron* place, const std::array<std::int32_t, 4>& rows,
                       std::size_t length, std::size_t parity) {
  const auto numbers = [&](std::size_t turn, std::size_t t) {
    Tetrahedron corners{};
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const int corner = kSplits[(parity + turn) % 2][t][c];
      corners[c] = rows[corner / 2] + corner % 2 + static_cast<std::int32_t>(turn);
    }
    return Four(corners);
  };
  std::array<Four, 2 * kPerVoxel> next{numbers(0, 0), numbers(0, 1), numbers(0, 2), numbers(0, 3),
                                       numbers(0, 4), numbers(1, 0), numbers(1, 1), numbers(1, 2),
                                       numbers(1, 3), numbers(1, 4)};
  const Four two({2, 2, 2, 2});
  for (std::size_t i = 0; i + 1 < length; i += 2) {
    for (Four& corners : next) {
      corners.put(place++);
      corners.add(two);
    }
  }
  if (length % 2 != 0) {
    for (std::size_t t = 0; t < kPerVoxel; ++t) {
      next[t].put(place++);
    }
  }
  return place;
}

void write_tetrahedra(const VoxelGrid& grid, const CornerNumbers& corners, TetMesh& mesh) {
  Tetrahedron* place = mesh.tetrahedra.data();
  for (std::int32_t k = 0; k < grid.size[2]; ++k) {
    for (std::int32_t j = 0; j < grid.size[1]; ++j) {
      each_run(corners.voxel_row(j, k), [&](std::size_t first, std::size_t last) {
        const std::array<std::int32_t, 4> rows{
            corners.number(first, j, k), corners.number(first, j + 1, k),
            corners.number(first, j, k + 1), corners.number(first, j + 1, k + 1)};
        const std::size_t parity = (first + static_cast<std::size_t>(j + k)) % 2;
        place = write_run(place, rows, last - first, parity);
      });
    }
  }
  Four::end();
}

}  // namespace

void tetrahedralize(const VoxelSolid& solid, TetMesh& mesh) {
  const CornerNumbers corners(solid);
  if (corners.inside() == 0) {
    throw InputError(
        "the solid has no voxel inside; choose a finer resolution, or repair the mesh if faces are "
        "there twice");
  }
  constexpr auto kMost = static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
  if (corners.vertices() > kMost) {
    throw InputError(
        fmt::format("the solid has {} voxel corners; allowed: {}; choose a coarser resolution",
                    corners.vertices(), kMost));
  }
  mesh.vertices.resize(corners.vertices());
  mesh.on_surface.resize(corners.vertices());
  mesh.tetrahedra.resize(kPerVoxel * corners.inside());
  write_vertices(solid.grid, corners, mesh);
  write_tetrahedra(solid.grid, corners, mesh);
}

TetMesh tetrahedralize(const VoxelSolid& solid) {
  TetMesh mesh;
  tetrahedralize(solid, mesh);
  return mesh;
}

double tetrahedralizing_memory(const VoxelGrid& grid, std::size_t inside) {
  // If no two voxels touch, each has eight corners of its own, but a grid has few more points than
  // voxels.
  const double points =
      static_cast<double>(grid.size[0] + 1.0) * (grid.size[1] + 1.0) * (grid.size[2] + 1.0);
  const double vertices = std::min(8.0 * static_cast<double>(inside), points);
  const double words = points / 64.0 + (grid.size[1] + 1.0) * (grid.size[2] + 1.0);
  return 80.0 * static_cast<double>(inside) + 25.0 * vertices + 20.0 * words;
}

}  // namespace haptrial::geometry
