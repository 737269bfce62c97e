#include "core/subject/drilling/drilling_chart.h"

#include <algorithm>
#include <cmath>

namespace haptrial::subject {
namespace {

constexpr float kFarInside = -1e-2F;  // [m]

/// Calls visit(column, height of the sphere there over its centre) for columns under a burr.
template <class Visit>
void under_burr(const DrillingChart& chart, int i, int j, double radius, const Visit& visit) {
  const int reach = static_cast<int>(radius / chart.cell);
  const double square = radius * radius / (chart.cell * chart.cell);
  for (int dj = std::max(-reach, -j); dj <= std::min(reach, chart.size[1] - 1 - j); ++dj) {
    for (int di = std::max(-reach, -i); di <= std::min(reach, chart.size[0] - 1 - i); ++di) {
      const double left = square - di * di - dj * dj;
      if (left >= 0.0) {
        visit(chart.column(i + di, j + dj), static_cast<float>(chart.cell * std::sqrt(left)));
      }
    }
  }
}

}  // namespace

float DrillingChart::clearance_at(const Eigen::Vector3d& p) const noexcept {
  const Eigen::Array3d at = p.array() / cell;
  const Eigen::Array3i low = at.floor().cast<int>();
  const Eigen::Array3d share = at - at.floor();
  float sum = 0.0F;
  for (int of_eight = 0; of_eight < 8; ++of_eight) {
    double weight = 1.0;
    std::size_t index = 0;
    for (int a = 2; a >= 0; --a) {
      const int up = (of_eight >> a) & 1;
      const int limit = size[static_cast<std::size_t>(a)];
      weight *= up == 1 ? share[a] : 1.0 - share[a];
      const int place = low[a] + up;
      if (weight > 0.0 && (place < 0 || place >= limit)) {
        return kFarInside;
      }
      index = index * static_cast<std::size_t>(limit) +
              static_cast<std::size_t>(std::clamp(place, 0, limit - 1));
    }
    sum += static_cast<float>(weight) * clearance[index];
  }
  return sum;
}

std::vector<float> cavity_floor(const DrillingChart& chart, const CavityView& view) {
  std::vector<float> floor(chart.surface);
  const double slope = chart.slope * view.slope;
  for (int j = 0; j < chart.size[1]; ++j) {
    for (int i = 0; i < chart.size[0]; ++i) {
      float& depth = floor[chart.column(i, j)];
      if (depth == DrillingChart::kNone) {
        continue;
      }
      const Eigen::Vector2d at(i * chart.cell, j * chart.cell);
      const double aside = (at - chart.end.head<2>() - view.shift).norm();
      const double side =
          chart.end.z() - std::max(0.0, (aside - chart.floor_radius) / std::max(slope, 1e-6));
      double w = depth;
      while (w + chart.cell <= side &&
             chart.clearance_at(Eigen::Vector3d(at.x(), at.y(), w) - view.offset) >= view.extra) {
        w += 0.5 * chart.cell;
      }
      depth = static_cast<float>(w);
    }
  }
  return floor;
}

BurrReach burr_reach(const DrillingChart& chart, const std::vector<float>& floor, double radius) {
  BurrReach reach;
  reach.centre.assign(chart.columns(), DrillingChart::kNone);
  reach.floor = chart.surface;
  for (int j = 0; j < chart.size[1]; ++j) {
    for (int i = 0; i < chart.size[0]; ++i) {
      float deepest = DrillingChart::kNone;
      under_burr(chart, i, j, radius, [&](std::size_t column, float height) {
        deepest = std::min(deepest, floor[column] - height);
      });
      reach.centre[chart.column(i, j)] = deepest;
      if (deepest == DrillingChart::kNone) {
        continue;
      }
      under_burr(chart, i, j, radius, [&](std::size_t column, float height) {
        if (reach.floor[column] != DrillingChart::kNone) {
          reach.floor[column] = std::max(reach.floor[column], deepest + height);
        }
      });
    }
  }
  return reach;
}

}  // namespace haptrial::subject
