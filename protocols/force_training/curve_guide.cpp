#include "protocols/force_training/curve_guide.h"

namespace haptrial::protocols {
namespace {
constexpr double kEnd = 5e-4;  // so near to the last point the path has been travelled [m]
}

CurveGuide::CurveGuide(const stimulus::SpatialTrajectory& path,
                       const control::CurveFollowing& following)
    : speed_(path.speed()),
      curve_(std::make_unique<control::SampledCurve>(path.points())),
      constraint_(*curve_, {}, following) {}

void CurveGuide::start() noexcept { constraint_.start_at(0.0); }

PointState CurveGuide::follow(const PointState& tool) noexcept { return constraint_.follow(tool); }

bool CurveGuide::at_end() const noexcept {
  return constraint_.place().arc >= curve_->length() - kEnd;
}

}  // namespace haptrial::protocols
