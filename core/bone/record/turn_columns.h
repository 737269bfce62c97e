#pragma once

#include <Eigen/Geometry>

#include "core/record/table/table.h"

namespace haptrial::record {

/// The four columns of an orientation, orientation_w to orientation_z.
template <class Row>
typename Table<Row>::Columns turn_columns(Eigen::Quaterniond Row::*of, const char* description) {
  using T = Table<Row>;
  typename T::Columns all;
  const auto add = [&](typename T::Columns one) { all.insert(all.end(), one.begin(), one.end()); };
  constexpr double kTurn = kOrientationResolution;
  add(T::rounded(
      "orientation_w", [of](Row& r) -> double& { return (r.*of).w(); }, "1", description, kTurn));
  add(T::rounded(
      "orientation_x", [of](Row& r) -> double& { return (r.*of).x(); }, "1", "likewise", kTurn));
  add(T::rounded(
      "orientation_y", [of](Row& r) -> double& { return (r.*of).y(); }, "1", "likewise", kTurn));
  add(T::rounded(
      "orientation_z", [of](Row& r) -> double& { return (r.*of).z(); }, "1", "likewise", kTurn));
  return all;
}

}  // namespace haptrial::record
