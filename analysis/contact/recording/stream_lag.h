#pragma once

#include <string>

#include "analysis/contact/recording/streams.h"

namespace haptrial::evaluation {

struct LagOptions {
  double largest{0.2};  // lags from -largest to largest are tried [s]
  double step{0.002};   // between them; the best is refined by a parabola [s]
  double slowest{0.5};  // changes slower than this are left out of both streams [s]
};

struct LagFit {
  double lag{0.0};  // the force stream's clock is ahead: force(t + lag) belongs to pose(t) [s]
  double low{0.0};  // 95 % interval by leaving out one of ten blocks at a time [s]
  double high{0.0};
  double explained{0.0};    // share of the force's quick changes that the pose explains at the lag
  std::string doubt;        // a sentence; empty: none
  double as_friction{0.0};  // change of the friction that fits best with the lag [1/s]
  bool like_friction{false};  // another friction mends most of what another lag spoils
};

/// The lag between two streams of one contact, from what both know. Quick changes of the force (in
/// W; slow ones are removed by a moving mean) are explained, by least squares at each lag, with
/// those of the position (a spring: onsets and taps), the velocity, its direction (friction: turns)
/// and the acceleration (inertia). The lag is the one that explains most.
///
/// Doubted where the pose explains little more at the lag than at others, where the best lag is the
/// largest that was tried, or where the interval is wider than `largest`.
/// @param force  in W, see contact_forces(); a lag of 50 ms hardly changes its orientation
/// @throws std::invalid_argument for a bad stream or option, or when the streams overlap by less
/// than 20 times largest or `slowest`.
LagFit estimate_lag(const PoseStream& pose, const ForceStream& force,
                    const LagOptions& options = {});

}  // namespace haptrial::evaluation
