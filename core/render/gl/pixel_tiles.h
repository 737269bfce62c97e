#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

namespace haptrial::render {

/// Pixels from min() to max(), both included, from the lower left of a framebuffer.
using PixelBox = Eigen::AlignedBox2i;

PixelBox all_pixels(int width, int height);

/// Which tiles of a picture something has to be done for, and what: a few boxes in place of many
/// that overlap.
class PixelTiles {
 public:
  static constexpr int kEdge = 32;  // [px]

  struct Part {
    PixelBox box;
    std::uint8_t what;  // the marks of all its tiles together
  };

  /// @param area  of the picture: nothing is done outside of it
  explicit PixelTiles(const PixelBox& area);

  /// Marks all tiles that a box meets; none for an empty one.
  void add(const PixelBox& box, std::uint8_t what = 1);
  /// All marked tiles within the area; no pixel is in two parts.
  std::vector<Part> parts() const;

 private:
  std::uint8_t& at(int column, int row) {
    return marks_[static_cast<std::size_t>(row + rows_ * column)];
  }

  PixelBox area_;
  int columns_;
  int rows_;
  std::vector<std::uint8_t> marks_;  // by tile, upwards first
};

}  // namespace haptrial::render
