#pragma once

#include "core/control/tutoring/tutoring_law.h"

namespace haptrial {
class Table;
}

namespace haptrial::protocols {

/// How a tutor leads, the table [tutoring] of a definition.
struct TutoringOptions {
  control::TutoringGains gains;
  double ramp{0.5};   // from no lead to all of it, and back [s]
  double speed{1.0};  // of a playback, 0.5 to 1 of the original
};

TutoringOptions read_tutoring_options(Table& table);

}  // namespace haptrial::protocols
