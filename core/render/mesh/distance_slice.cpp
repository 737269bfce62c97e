#include "core/render/mesh/distance_slice.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/render/gl/colour.h"

namespace haptrial::render {
namespace {

constexpr Colour kInside{0.12, 0.35, 0.66}, kOutside{0.85, 0.42, 0.10}, kPale{0.97, 0.96, 0.94};
constexpr Colour kLine{0.10, 0.10, 0.12}, kNothing{1.0, 1.0, 1.0};
constexpr int kContours = 10;

Colour mix(const Colour& a, const Colour& b, double share) {
  return {a.red + share * (b.red - a.red), a.green + share * (b.green - a.green),
          a.blue + share * (b.blue - a.blue)};
}

class Painter {
 public:
  Painter(const DistanceSlice& slice, double pixel) : slice_(slice), pixel_(pixel) {
    for (const double value : slice.values) {
      if (!std::isnan(value)) {
        largest_ = std::max(largest_, std::abs(value));
      }
    }
  }

  /// @param x, y  in samples
  Colour at(double x, double y) const {
    const double value = sample(x, y);
    if (std::isnan(value)) {
      return kNothing;
    }
    if (largest_ == 0.0) {
      return kLine;
    }
    const double step = largest_ / kContours;
    const double band = std::min(std::floor(std::abs(value) / step), kContours - 1.0) + 0.5;
    const Colour field =
        mix(value < 0.0 ? kInside : kOutside, kPale, 0.85 * std::sqrt(band / kContours));
    const double to_contour = std::abs(value - step * std::round(value / step));
    const double to_surface = std::abs(value);
    const double surface = std::clamp(1.8 - to_surface / pixel_, 0.0, 1.0);
    const double contour = 0.35 * std::clamp(1.0 - to_contour / pixel_, 0.0, 1.0);
    return mix(field, kLine, std::max(surface, contour));
  }

 private:
  double value(int column, int row) const {
    column = std::clamp(column, 0, slice_.columns - 1);
    row = std::clamp(row, 0, slice_.rows - 1);
    return slice_.values[static_cast<std::size_t>(row) * std::size_t(slice_.columns) +
                         static_cast<std::size_t>(column)];
  }
  /// The nearest sample where one of the four around has no number.
  double sample(double x, double y) const {
    const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
    const double u = x - column, v = y - row;
    const double low = (1.0 - u) * value(column, row) + u * value(column + 1, row);
    const double high = (1.0 - u) * value(column, row + 1) + u * value(column + 1, row + 1);
    const double between = (1.0 - v) * low + v * high;
    return std::isnan(between)
               ? value(static_cast<int>(std::lround(x)), static_cast<int>(std::lround(y)))
               : between;
  }

  const DistanceSlice& slice_;
  double pixel_;  // [m]
  double largest_{0.0};
};

}  // namespace

Image draw_distances(const DistanceSlice& slice, int size) {
  if (slice.columns < 1 || slice.rows < 1 || size < 1 ||
      slice.values.size() != std::size_t(slice.columns) * std::size_t(slice.rows)) {
    throw std::invalid_argument("draw_distances: values must be rows x columns, size above 0");
  }
  const double samples_per_pixel = static_cast<double>(std::max(slice.columns, slice.rows)) / size;
  Image image;
  image.width = std::max(1, static_cast<int>(std::lround(slice.columns / samples_per_pixel)));
  image.height = std::max(1, static_cast<int>(std::lround(slice.rows / samples_per_pixel)));
  image.rgb.reserve(3 * std::size_t(image.width) * std::size_t(image.height));
  const Painter painter(slice, slice.spacing * samples_per_pixel);
  for (int row = image.height - 1; row >= 0; --row) {
    for (int column = 0; column < image.width; ++column) {
      const Colour colour = painter.at((column + 0.5) * samples_per_pixel - 0.5,
                                       (row + 0.5) * samples_per_pixel - 0.5);
      for (const double part : {colour.red, colour.green, colour.blue}) {
        image.rgb.push_back(static_cast<std::uint8_t>(std::lround(255.0 * part)));
      }
    }
  }
  return image;
}

}  // namespace haptrial::render
