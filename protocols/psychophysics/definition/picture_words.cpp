#include "protocols/psychophysics/definition/picture_words.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "protocols/psychophysics/definition/presented.h"

namespace haptrial::protocols {
namespace {

/// The farthest place of a region that is drawn, from the middle of W along each axis [m].
Eigen::Vector3d reach_of(const scene::Shape& shape) {
  const scene::ShapeBall ball = scene::ball_of(shape);
  return ball.centre.cwiseAbs() + Eigen::Vector3d::Constant(ball.radius);
}

}  // namespace

void PictureReport::add(const Presented& presented) {
  const double eyes = d_.view.stereo ? 2.0 : 1.0;
  const double aspect = d_.display.width / (eyes * d_.display.height);
  for (const NamedStage& stage : presented.stages) {
    for (const std::string& name : stage.show) {
      const auto region = std::ranges::find(presented.regions, name, &scene::Region::name);
      if (region == presented.regions.end()) {
        continue;
      }
      const Eigen::Vector3d reach = reach_of(region->shape);
      const double down = d_.view.from_above ? reach.z() : reach.y();
      const double needed = 2.0 * std::max(reach.x(), aspect * down);
      if (needed > d_.view.width) {
        outside_[name] = std::max(outside_[name], needed);
      }
    }
  }
}

std::vector<std::string> PictureReport::warnings() const {
  std::vector<std::string> all;
  for (const auto& [name, needed] : outside_) {
    all.push_back(fmt::format(
        "region {} lies partly outside of the participant's picture, which is {:g} m wide; "
        "display.extent = {:g} shows all of it",
        name, d_.view.width, std::ceil(100.0 * needed) / 100.0));
  }
  return all;
}

}  // namespace haptrial::protocols
