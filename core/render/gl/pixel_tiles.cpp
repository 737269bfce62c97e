#include "core/render/gl/pixel_tiles.h"

namespace haptrial::render {
namespace {

int tiles_in(int pixels) { return (pixels + PixelTiles::kEdge - 1) / PixelTiles::kEdge; }

/// Tiles of one column with the same marks, from a row up to another.
struct Run {
  int first;
  int end;
  std::uint8_t what;
  bool operator==(const Run&) const = default;
};

std::vector<Run> runs_in(const std::uint8_t* column, int rows) {
  std::vector<Run> runs;
  for (int row = 0; row < rows; ++row) {
    if (column[row] == 0) {
      continue;
    }
    if (!runs.empty() && runs.back().end == row && runs.back().what == column[row]) {
      ++runs.back().end;
    } else {
      runs.push_back({row, row + 1, column[row]});
    }
  }
  return runs;
}

}  // namespace

PixelBox all_pixels(int width, int height) {
  return {Eigen::Vector2i(0, 0), Eigen::Vector2i(width - 1, height - 1)};
}

PixelTiles::PixelTiles(const PixelBox& area)
    : area_(area),
      columns_(tiles_in(area.sizes().x() + 1)),
      rows_(tiles_in(area.sizes().y() + 1)),
      marks_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0) {}

void PixelTiles::add(const PixelBox& box, std::uint8_t what) {
  const PixelBox inside = box.intersection(area_);
  if (box.isEmpty() || inside.isEmpty()) {
    return;
  }
  const Eigen::Vector2i first = (inside.min() - area_.min()) / kEdge;
  const Eigen::Vector2i last = (inside.max() - area_.min()) / kEdge;
  for (int column = first.x(); column <= last.x(); ++column) {
    for (int row = first.y(); row <= last.y(); ++row) {
      at(column, row) |= what;
    }
  }
}

/// Columns whose runs are the same are taken together.
std::vector<PixelTiles::Part> PixelTiles::parts() const {
  std::vector<Part> parts;
  const auto runs_of = [&](int column) { return runs_in(marks_.data() + rows_ * column, rows_); };
  for (int column = 0; column < columns_;) {
    const std::vector<Run> runs = runs_of(column);
    int end = column + 1;
    while (end < columns_ && runs_of(end) == runs) {
      ++end;
    }
    for (const Run& run : runs) {
      const Eigen::Vector2i low(kEdge * column, kEdge * run.first);
      const Eigen::Vector2i high(kEdge * end - 1, kEdge * run.end - 1);
      parts.push_back(
          {PixelBox(area_.min() + low, area_.min() + high).intersection(area_), run.what});
    }
    column = end;
  }
  return parts;
}

}  // namespace haptrial::render
