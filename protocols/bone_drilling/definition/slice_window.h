#pragma once

namespace haptrial::protocols {

/// Range of densities that the grey of a slice spans: `low` and below is black, `high` white.
struct SliceWindow {
  double low{0.0};
  double high{1.0};  // > low
};

}  // namespace haptrial::protocols
