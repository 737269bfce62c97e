#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/base/random.h"
#include "core/subject/drilling/drilling_chart.h"

namespace haptrial::subject {

/// A bout of strokes: to and fro between two places over the bone.
struct StrokeSeries {
  Eigen::Vector2d from{Eigen::Vector2d::Zero()};  // (u, v) [m]
  Eigen::Vector2d to{Eigen::Vector2d::Zero()};
  bool under{false};  // goes under an edge: beyond the cavity, no deeper than it began
};

/// How the next bout is chosen.
struct StrokeChoice {
  double evenness{1.0};  // as DrillingSkill
  double length{8e-3};   // of strokes [m]
  double bite{1e-3};     // bone that is so much deeper is no part of a stroke [m]
  double undercut{0.0};  // share of bouts
};

/// A driller's mental picture: how deep the bone goes down in each column, from the first sight and
/// from the burr's places since; and how far it is to go. Not from the bone itself. Nothing but
/// construction and begin_burr() allocates.
class DrillingMemory {
 public:
  explicit DrillingMemory(const DrillingChart& chart);

  /// Begins with the bone as it is seen before anything was done.
  void begin(const std::vector<float>& surface) noexcept;
  /// Goes on with this burr. Copies within what was allocated.
  void begin_burr(const BurrReach& reach, double radius) noexcept;

  /// The burr has been there, turning. @param place  of its centre (u, v, w)
  void sweep(const Eigen::Vector3d& place) noexcept;
  /// The deepest that its centre may go at a place. [m]
  double limit(const Eigen::Vector2d& place) const noexcept;
  /// Depth at which the burr's centre touches the bone that stands at a place; 1 if there is no
  /// bone. [m]
  double touch(const Eigen::Vector2d& place) const noexcept;
  /// Height over all that stands between two places. [m]
  double over(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const noexcept;

  /// The share of the bone that this burr is to take and that is still there: 0 to 1.
  double left() const noexcept;
  /// @returns false where nothing is left. @param now  where the hand is
  bool choose(const StrokeChoice& choice, const Eigen::Vector2d& now, RandomStream& random,
              StrokeSeries& strokes) noexcept;
  /// Takes as gone, after a bout, the bone that it did not get any deeper after a third try.
  void end_strokes(const StrokeSeries& strokes) noexcept;

  /// The middle of all that is to go, (u, v, w) with w at the surface.
  const Eigen::Vector3d& opening() const noexcept { return opening_; }

 private:
  struct Cell {
    int i, j;
  };
  Cell cell_at(const Eigen::Vector2d& place) const noexcept;
  bool inside(int i, int j) const noexcept {
    return i >= 0 && j >= 0 && i < chart_.size[0] && j < chart_.size[1];
  }
  float to_go(std::size_t column) const noexcept;
  int run(const Cell& from, double angle, float highest, const StrokeChoice& choice) const noexcept;
  void choose_under(const Cell& at, const StrokeChoice& choice, RandomStream& random,
                    StrokeSeries& strokes) noexcept;

  const DrillingChart& chart_;
  std::vector<float> height_;  // (u x v) depth at which bone begins now
  std::vector<float> centre_;  // (u x v) of BurrReach
  std::vector<float> floor_;
  std::vector<float> before_;        // heights at the beginning of the bout
  std::vector<std::uint8_t> tries_;  // bouts in vain
  double radius_{1e-3};
  double total_{1.0};  // of the burr's share at its beginning [m]
  Eigen::Vector3d opening_{Eigen::Vector3d::Zero()};
};

}  // namespace haptrial::subject
