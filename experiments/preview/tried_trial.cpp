#include "experiments/preview/tried_trial.h"

#include <fmt/format.h>

#include <cmath>
#include <istream>
#include <nlohmann/json.hpp>
#include <ostream>
#include <sstream>
#include <utility>

#include "core/scene/scene.h"
#include "experiments/preview/preview_pictures.h"
#include "protocols/psychophysics/objects/deformable_bodies.h"
#include "protocols/psychophysics/preview/previewed_trial.h"

namespace haptrial::experiments {
namespace {

using Eigen::Vector3d;
using nlohmann::json;

class TriedScenes final : public TriedTrial {
 public:
  TriedScenes(const protocols::StudiedDefinition& d, const PreviewRequest& request)
      : d_(d),
        trial_(protocols::previewed_trial(d, previewed_session(request.seed), request.trial)),
        mouse_(page_hand(d, trial_.intervals.front().start)) {
    for (protocols::PreviewedInterval& interval : trial_.intervals) {
      protocols::prepare_bodies(interval.presented.fields, d.rate);
    }
    for (std::size_t i = 0; i < trial_.intervals.size(); ++i) {
      for (std::size_t s = 0; s < trial_.intervals[i].stages.size(); ++s) {
        places_.push_back({i, s});
      }
    }
    choose(0);
  }

  double rate() const override { return d_.rate; }
  Vector3d start() const override { return trial_.intervals.front().start; }
  double reach() const override { return mouse_.info().workspace_radius; }
  std::vector<std::string> stages() const override {
    std::vector<std::string> names;
    for (const protocols::StagePlace& place : places_) {
      names.push_back(stage_name(trial_, place));
    }
    return names;
  }
  std::vector<SpaceObject> objects() const override { return objects_of(trial_); }

  void choose(std::size_t stage) override {
    const protocols::StagePlace& place = places_.at(stage);
    const protocols::Presented& presented = trial_.intervals[place.interval].presented;
    if (!scene_ || interval_ != place.interval) {
      scene_.emplace(presented.fields, d_.rate);
      interval_ = place.interval;
    }
    scene_->switch_to(presented.stages[place.stage].stage.fields & presented.felt.front());
    chosen_ = stage;
  }
  std::string now() const override { return stage_name(trial_, places_[chosen_]); }

  Moment tick(const Vector3d& pointer) override {
    mouse_.reach({pointer, Eigen::Quaterniond::Identity()});
    device::DeviceReading reading;
    mouse_.read(reading);
    const Vector3d force = scene_->force(reading.tool, reading.shares);
    mouse_.write({force});
    return {reading.tool, force};
  }

 private:
  const protocols::StudiedDefinition& d_;
  protocols::PreviewedTrial trial_;
  device::MouseDevice mouse_;
  std::vector<protocols::StagePlace> places_;
  std::optional<scene::Scene> scene_;
  std::size_t interval_{0};
  std::size_t chosen_{0};
};

std::string head_of(const TriedTrial& trial) {
  const Vector3d start = trial.start();
  json objects = json::array();
  for (const SpaceObject& object : trial.objects()) {
    objects.push_back({{"name", object.name},
                       {"interval", object.interval},
                       {"lines", line_numbers(object.lines)}});
  }
  const json head{{"rate", trial.rate()},
                  {"start", {start.x(), start.y(), start.z()}},
                  {"reach", trial.reach()},
                  {"stages", trial.stages()},
                  {"objects", objects}};
  return head.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// The loop of a trial and how far its time has come.
class LineLoop {
 public:
  explicit LineLoop(TriedTrial& trial) : trial_(trial), stages_(trial.stages().size()) {}

  std::string answer(const std::string& line) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "stage") {
      return choose(words);
    }
    return word == "to" ? lead(words) : "? a line begins with 'stage' or 'to'";
  }

 private:
  std::string choose(std::istringstream& words) {
    long stage = 0;
    if (!(words >> stage) || stage < 1 || stage > static_cast<long>(stages_)) {
      return fmt::format("? allowed: stage 1 to stage {}", stages_);
    }
    trial_.choose(static_cast<std::size_t>(stage - 1));
    return fmt::format("stage {}", stage);
  }
  std::string lead(std::istringstream& words) {
    constexpr double kLongest = 0.5;  // [s]
    double time = 0.0;
    Vector3d pointer;
    if (!(words >> time >> pointer.x() >> pointer.y() >> pointer.z()) || !std::isfinite(time) ||
        !pointer.allFinite()) {
      return "? allowed: to TIME X Y Z, four numbers";
    }
    const double ahead = std::min(time - time_, kLongest);
    const auto ticks = std::lround(std::max(0.0, ahead) * trial_.rate());
    for (long i = 0; i < ticks; ++i) {
      moment_ = trial_.tick(pointer);
    }
    time_ = std::max(time_, time);
    const Vector3d& p = moment_.hand.position;
    const Vector3d& f = moment_.force;
    return fmt::format("{} {} {} {} {} {} {} {}", time, p.x(), p.y(), p.z(), f.x(), f.y(), f.z(),
                       trial_.now());
  }

  TriedTrial& trial_;
  std::size_t stages_;
  double time_{0.0};  // [s]
  TriedTrial::Moment moment_;
};

}  // namespace

device::MouseDevice page_hand(const protocols::Definition& definition, const Vector3d& start) {
  device::MouseParameters mouse = definition.mouse;
  mouse.in_space = true;
  mouse.start = start;
  return {mouse, definition.rate};
}

std::shared_ptr<TriedTrial> tried_scenes(const protocols::StudiedDefinition& definition,
                                         const PreviewRequest& request) {
  return std::make_shared<TriedScenes>(definition, request);
}

void try_lines(TriedTrial& trial, std::istream& in, std::ostream& out) {
  out << head_of(trial) << std::endl;  // whoever reads waits for each line
  LineLoop loop(trial);
  for (std::string line; std::getline(in, line);) {
    out << loop.answer(line) << std::endl;
  }
}

TriedPass::TriedPass(const protocols::Definition& definition, const Eigen::Vector3d& start)
    : rate_(definition.rate), start_(start), mouse_(page_hand(definition, start)) {}

void TriedPass::begin(std::unique_ptr<protocols::Pass> pass) {
  pass_ = std::move(pass);
  pass_->begin(0);
  output_ = {};
}

TriedTrial::Moment TriedPass::tick(const Eigen::Vector3d& pointer) {
  before_tick();
  mouse_.reach({pointer, Eigen::Quaterniond::Identity()});
  device::DeviceReading reading;
  mouse_.read(reading);
  reading.buttons = buttons_;
  output_ = is_over() ? protocols::PassOutput{} : pass_->tick(reading, 1.0 / rate_);
  mouse_.write({output_.force});
  return {reading.tool, output_.force};
}

}  // namespace haptrial::experiments
