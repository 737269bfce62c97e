#include "analysis/bone_drilling/phases/action.h"

#include <algorithm>
#include <cmath>

#include "analysis/bone_drilling/metrics/strokes.h"
#include "core/bone/model/distance_field.h"

namespace haptrial::analysis::drilling {
namespace {

constexpr double kRest = 1.0;         // a longer time without a stroke is an action [s]
constexpr double kNear = 10e-3;       // how far structures are looked for [m]
constexpr double kDeepest = 25e-3;    // how deep depths are known [m]
constexpr double kEvery = 0.01;       // time between the ticks that are looked at [s]
constexpr double kLeastForce = 0.02;  // added before the logarithm [N]
constexpr double kLeastSpeed = 1.0;   // likewise [mm/s]
constexpr double kMillimetres = 1e3;

/// Ticks, both inclusive, with a stroke or without.
struct Stretch {
  std::size_t first, last;
  bool stroke;
};

/// Divides ticks without a stroke into stretches of about kRest.
void add_rest(std::size_t first, std::size_t end, double rate, std::vector<Stretch>& stretches) {
  const double seconds = static_cast<double>(end - first) / rate;
  const auto parts = static_cast<std::size_t>(std::max(1.0, std::round(seconds / kRest)));
  for (std::size_t n = 0; n < parts; ++n) {
    const std::size_t from = first + (end - first) * n / parts;
    const std::size_t to = first + (end - first) * (n + 1) / parts;
    if (to > from) {
      stretches.push_back({from, to - 1, false});
    }
  }
}

/// Stretches in order; a short time without a stroke is left out.
std::vector<Stretch> stretches_of(const Procedure& p) {
  const auto shortest = static_cast<std::size_t>(kRest * p.rate);
  std::vector<Stretch> stretches;
  std::size_t next = 0;
  const auto rest_until = [&](std::size_t end) {
    if (end > next && (end - next > shortest || stretches.empty())) {
      add_rest(next, end, p.rate, stretches);
    }
  };
  for (const Stroke& stroke : find_strokes(p)) {
    rest_until(stroke.first);
    stretches.push_back({stroke.first, stroke.last, true});
    next = stroke.last + 1;
  }
  rest_until(p.ticks.size());
  return stretches;
}

class Observer {
 public:
  Observer(const Procedure& p, StudyBones& bones)
      : p_(p),
        pose_BW_(p.pose_WB.inverse(Eigen::Isometry)),
        step_(static_cast<std::size_t>(std::max(1.0, kEvery * p.rate))),
        names_(bone::vital_structures(*p.bone)),
        air_(bones.air_around(p.bone, std::min(kDeepest, farthest()))) {
    for (const std::string& name : names_) {
      fields_.push_back(
          bones.field(p.bone, bone::labels_named(*p.bone, name), std::min(kNear, farthest())));
    }
  }

  Action action(const Stretch& stretch, std::size_t end) {
    Action action;
    action.first = stretch.first;
    action.last = end - 1;
    const ProcedureTool* tool = p_.tool(p_.ticks[stretch.first].tool);
    action.word(ActionWord::kTool) =
        (tool == nullptr ? "none" : tool->name) + (stretch.stroke ? " at work" : "");
    measure(stretch, action);
    look(p_.ticks[stretch.first].sequence, p_.ticks[end - 1].sequence, action);
    return action;
  }

 private:
  double farthest() const { return 250.0 * p_.bone->grid.spacing; }

  bone::Voxel voxel(const ToolTick& tick) const {
    return p_.bone->grid.nearest(pose_BW_ * tick.position);
  }

  /// Means over the ticks of a stretch.
  void measure(const Stretch& stretch, Action& action) const {
    double depth = 0.0, force = 0.0, speed = 0.0, count = 0.0, clearance = kNear;
    std::int32_t structure = -1;
    for (std::size_t i = stretch.first; i <= stretch.last; i += step_) {
      const ToolTick& tick = p_.ticks[i];
      const bone::Voxel at = voxel(tick);
      depth += air_->at(at).value_or(beyond(at));
      force += tick.force;
      speed += tick.velocity.norm();
      count += 1.0;
      const bone::NearestStructure near = bone::nearest_structure(fields_, at);
      if (near.structure >= 0 && static_cast<double>(near.distance) < clearance) {
        clearance = static_cast<double>(near.distance);
        structure = near.structure;
      }
    }
    action.word(ActionWord::kStructure) =
        structure < 0 ? "none" : names_[static_cast<std::size_t>(structure)];
    action.number(ActionNumber::kDepth) = kMillimetres * depth / count;
    action.number(ActionNumber::kClearance) = kMillimetres * clearance;
    action.number(ActionNumber::kForce) = std::log(kLeastForce + force / count);
    action.number(ActionNumber::kSpeed) = std::log(kLeastSpeed + kMillimetres * speed / count);
  }

  /// Depth where the field knows none: outside of the grid there is air.
  double beyond(const bone::Voxel& at) const {
    return p_.bone->grid.contains(at) && !air_->empty() ? air_->reach() : 0.0;
  }

  /// The view from the first tick of an action to its last.
  void look(std::uint64_t first, std::uint64_t last, Action& action) {
    bool moved = false;
    while (view_ < p_.views.size() && p_.views[view_].sequence <= last) {
      moved = moved || p_.views[view_].sequence > first;
      ++view_;
    }
    action.word(ActionWord::kView) = moved ? "moved" : "still";
    const View* view = view_ > 0 ? &p_.views[view_ - 1] : nullptr;
    action.number(ActionNumber::kSeen) = view == nullptr ? 0.0 : std::log(seen_height(*view));
  }

  static double seen_height(const View& view) {
    const double away = kMillimetres * (view.eye - view.target).norm();
    return std::max(1.0, 2.0 * away * std::tan(0.5 * view.field_of_view));
  }

  const Procedure& p_;
  Eigen::Isometry3d pose_BW_;
  std::size_t step_;  // [ticks]
  std::vector<std::string> names_;
  std::vector<std::shared_ptr<const bone::DistanceField>> fields_;  // (names_)
  std::shared_ptr<const bone::DistanceField> air_;
  std::size_t view_{0};  // the first one that is not yet looked at
};

}  // namespace

std::vector<Action> actions_of(const Procedure& p, StudyBones& bones) {
  if (p.ticks.empty()) {
    return {};
  }
  const std::vector<Stretch> stretches = stretches_of(p);
  Observer observer(p, bones);
  std::vector<Action> actions;
  for (std::size_t n = 0; n < stretches.size(); ++n) {
    const std::size_t end = n + 1 < stretches.size() ? stretches[n + 1].first : p.ticks.size();
    actions.push_back(observer.action(stretches[n], end));
  }
  return actions;
}

}  // namespace haptrial::analysis::drilling
