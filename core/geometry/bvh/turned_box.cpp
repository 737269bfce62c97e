#include "core/geometry/bvh/turned_box.h"

#include <cmath>
#include <limits>

namespace haptrial::geometry {
namespace {

Four turned_left(Four v) { return __builtin_shufflevector(v, v, 1, 2, 0, 3); }

Four cross(Four a, Four b) { return turned_left(a * turned_left(b) - turned_left(a) * b); }

float dot(Four a, Four b) {
  const Four products = a * b;
  return products[0] + products[1] + products[2];
}

/// Columns of the axes, so that x column[0] + y column[1] + z column[2] are the coordinates of
/// (x, y, z) along all three at once.
struct Axes {
  Four axis[3];
  Four column[3];

  Axes(Four a, Four b, Four c) : axis{a, b, c} {
    for (int i = 0; i < 3; ++i) {
      column[i] = Four{a[i], b[i], c[i], 0.0f};
    }
  }
  Four along(Four p) const {
    return all_four(p[0]) * column[0] + all_four(p[1]) * column[1] + all_four(p[2]) * column[2];
  }
};

/// Axes with the third along the normal of the patch; false where it has none to speak of.
bool patch_normal(std::span<const Four> corners, Four& normal) {
  Four sum{};
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    sum += cross(corners[i + 1] - corners[i], corners[i + 2] - corners[i]);
  }
  const float length = std::sqrt(dot(sum, sum));
  if (!(length > 1e-20f)) {
    return false;
  }
  normal = sum / all_four(length);
  return true;
}

/// Turned about the third axis so that the first is where the points spread most.
Axes turn_to_spread(std::span<const Four> points, const Axes& axes) {
  Four mean{};
  for (const Four& p : points) {
    mean += p;
  }
  mean /= all_four(static_cast<float>(points.size()));
  Four squares{};  // xx, yy, xy of coordinates along the axes
  for (const Four& p : points) {
    const Four at = axes.along(p - mean);
    squares +=
        __builtin_shufflevector(at, at, 0, 1, 0, 3) * __builtin_shufflevector(at, at, 0, 1, 1, 3);
  }
  const float angle = 0.5f * std::atan2(2.0f * squares[2], squares[0] - squares[1]);
  const Four c = all_four(std::cos(angle)), s = all_four(std::sin(angle));
  return {c * axes.axis[0] + s * axes.axis[1], c * axes.axis[1] - s * axes.axis[0], axes.axis[2]};
}

void write(const Axes& axes, Four low, Four high, TurnedBoxes& boxes, int place) {
  const Four middle = (low + high) * all_four(0.5f), half = (high - low) * all_four(0.5f);
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      boxes.row[i][k][place] = axes.axis[i][k];
    }
    boxes.row[i][3][place] = -middle[i];
    boxes.half[i][place] = half[i];
  }
}

const Axes& upright() {
  static const Axes axes(Four{1, 0, 0, 0}, Four{0, 1, 0, 0}, Four{0, 0, 1, 0});
  return axes;
}

}  // namespace

void write_upright(const FourBox& box, TurnedBoxes& boxes, int place) {
  write(upright(), box.low, box.high, boxes, place);
}

void write_turned(std::span<const Four> corners, const FourBox& box, TurnedBoxes& boxes,
                  int place) {
  Four normal;
  if (!patch_normal(corners, normal)) {
    return write_upright(box, boxes, place);
  }
  int least = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::abs(normal[i]) < std::abs(normal[least])) {
      least = i;
    }
  }
  Four beside = cross(normal, upright().axis[least]);
  beside /= all_four(std::sqrt(dot(beside, beside)));
  const Axes axes = turn_to_spread(corners, {beside, cross(normal, beside), normal});
  FourBox turned;
  for (const Four& p : corners) {
    turned.add(axes.along(p));
  }
  if (turned.half_area() < box.half_area()) {
    write(axes, turned.low, turned.high, boxes, place);
  } else {
    write_upright(box, boxes, place);
  }
}

void leave_empty(TurnedBoxes& boxes, int place) {
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 4; ++k) {
      boxes.row[i][k][place] = 0.0f;
    }
    boxes.half[i][place] = -std::numeric_limits<float>::infinity();
  }
}

}  // namespace haptrial::geometry
