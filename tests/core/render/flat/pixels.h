#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdlib>
#include <span>

#include "core/render/flat/trial_display.h"
#include "core/render/flat/view.h"
#include "core/render/gl/colour.h"
#include "core/render/gl/image.h"

namespace haptrial::render {

inline Image render_presentation(const TrialDisplayStyle& style,
                                 std::span<const Eigen::Vector3d> trajectory,
                                 const stimulus::Presentation& presentation) {
  FrameRenderer renderer(style);
  renderer.set_trajectory(trajectory);
  return renderer.draw(presentation);
}

/// The whole picture as a rectangle [px].
inline Rectangle all_of(const Image& image) {
  return {{0.0, 0.0}, {static_cast<double>(image.width), static_cast<double>(image.height)}};
}

/// Red, green and blue of a pixel, 0 to 255.
inline Eigen::Vector3d pixel(const Image& image, int x, int y) {
  const std::uint8_t* p = image.rgb.data() + 3 * (static_cast<std::size_t>(y) * image.width + x);
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

inline Eigen::Vector3d bytes_of(const Colour& colour) {
  return 255.0 * Eigen::Vector3d(colour.red, colour.green, colour.blue);
}

/// Whether a pixel has a colour, to the rounding of one blend. Plain numbers: whole pictures are
/// looked through in tests that are compiled without optimisation.
inline bool has_colour(const Image& image, int x, int y, const Colour& colour) {
  constexpr float kRounding = 1.6F;
  const std::uint8_t* p = image.rgb.data() + 3 * (static_cast<std::size_t>(y) * image.width + x);
  return std::fabs(p[0] - 255.0F * colour.red) < kRounding &&
         std::fabs(p[1] - 255.0F * colour.green) < kRounding &&
         std::fabs(p[2] - 255.0F * colour.blue) < kRounding;
}

struct Blob {
  int count{0};                                     // [px]
  Eigen::Vector2d centre{Eigen::Vector2d::Zero()};  // mean of the pixels' centres [px]
  int left{1 << 30}, top{1 << 30}, right{-1}, bottom{-1};
};

/// The pixels of one colour.
inline Blob find(const Image& image, const Colour& colour) {
  Blob blob;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (!has_colour(image, x, y, colour)) {
        continue;
      }
      ++blob.count;
      blob.centre += Eigen::Vector2d(x + 0.5, y + 0.5);
      blob.left = std::min(blob.left, x);
      blob.right = std::max(blob.right, x);
      blob.top = std::min(blob.top, y);
      blob.bottom = std::max(blob.bottom, y);
    }
  }
  if (blob.count > 0) {
    blob.centre /= blob.count;
  }
  return blob;
}

/// The area [px²] that `paint` covers of `background` within whole pixels low <= p < high, pixels
/// covered in part included.
inline double covered(const Image& image, const Rectangle& part, const Colour& background,
                      const Colour& paint) {
  const Eigen::Vector3d ground = bytes_of(background);
  const Eigen::Vector3d way = bytes_of(paint) - ground;
  double area = 0.0;
  for (int y = static_cast<int>(part.low.y()); y < static_cast<int>(part.high.y()); ++y) {
    for (int x = static_cast<int>(part.low.x()); x < static_cast<int>(part.high.x()); ++x) {
      area += (pixel(image, x, y) - ground).dot(way) / way.squaredNorm();
    }
  }
  return area;
}

}  // namespace haptrial::render
