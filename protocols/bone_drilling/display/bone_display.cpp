#include "protocols/bone_drilling/display/bone_display.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/bone/model/distance_field.h"
#include "core/bone/simulator/plate_shapes.h"
#include "core/bone/simulator/saw.h"
#include "core/render/bone/bone_tools.h"
#include "core/render/bone/surgical_field.h"

namespace haptrial::protocols {
namespace {

const render::Colour kSteel{0.72, 0.74, 0.78};
const render::Colour kPlate{0.60, 0.66, 0.72};
const render::Colour kPlane{0.35, 0.65, 1.0, 0.4};

/// The right button turns the tool where it has no other meaning.
device::PointerHandParameters pointer_hand_of(const BoneDefinition& d) {
  device::PointerHandParameters p;
  p.start = d.mouse.start / d.drilling.scale;
  const auto uses = [&p](std::uint32_t buttons) {
    return device::is_pressed(buttons, p.turn_button);
  };
  if (d.mouse.stop_button == p.turn_button ||
      std::any_of(d.drilling.controls.buttons.begin(), d.drilling.controls.buttons.end(), uses)) {
    p.turn_button = -1;
  }
  p.reach /= d.drilling.scale;
  return p;
}

std::vector<render::Capsule> tube_shadow(double radius, double length) {
  return {{Eigen::Vector3d::Zero(), length * Eigen::Vector3d::UnitZ(), 2.0 * radius}};
}

render::BurrLook look_of(const bone::BurrTool& tool, double length) {
  const bone::BurrParameters& burr = tool.burr;
  render::BurrLook look;
  look.head = burr.dimensions();
  look.cutting = burr.kind == bone::BurrKind::kCutting;
  look.clockwise = burr.clockwise;
  const double neck = burr.form == bone::BurrForm::kPear ? burr.narrow_diameter : burr.diameter;
  look.shaft_diameter = std::min(render::burr_shaft(burr.diameter), neck);
  look.length = length;
  if (tool.shaft) {
    look.shaft_diameter = 2.0 * tool.shaft->radius;
    look.shaft_length = tool.shaft->length;
  }
  return look;
}

render::SawLook saw_look_of(const bone::BurrTool& saw, double length) {
  const bone::BurrParameters& teeth = saw.burr;
  return {teeth.diameter,    teeth.narrow_diameter, teeth.length,
          saw.shaft->length, saw.shaft->thickness,  teeth.length + saw.shaft->length + length};
}

/// A text in which a word in braces is replaced.
std::string with(std::string text, std::string_view word, const std::string& by) {
  for (std::size_t at = text.find(word); at != std::string::npos;
       at = text.find(word, at + by.size())) {
    text.replace(at, word.size(), by);
  }
  return text;
}

/// Minutes and whole seconds: "0:31".
std::string clock_time(double seconds) {
  const auto whole = static_cast<int>(std::max(0.0, seconds));
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

using Clock = std::chrono::steady_clock;

class BoneDrawing final : public Drawing {
 public:
  BoneDrawing(const render::Gl& gl, const BoneDefinition& definition,
              std::shared_ptr<const BoneStage> stage, int width, int height,
              std::shared_ptr<bone::Surface> surface)
      : definition_(definition),
        display_(gl, definition, std::move(stage), width, height, render::microscope_style(),
                 std::move(surface)),
        hand_(pointer_hand_of(definition)),
        chosen_(definition.quality) {}
  void draw(const stimulus::Shown& shown) override {
    const auto* seen = shown.as<bone::DrillingView>();
    seen_ = seen != nullptr ? *seen : bone::DrillingView{};
    const Clock::time_point now = Clock::now();
    const std::chrono::duration<double> interval = now - std::exchange(last_, now);
    const render::Quality by_time = steps_.next(interval.count());
    display_.set_quality(chosen_.value_or(by_time));
    display_.draw(seen_);
  }
  /// V: all that can be drawn, with less and with least, and then by time again. P: the plan.
  /// C: slices as of a scan.
  void pressed(int key) override {
    if (definition_.bits_of({key}) != 0) {
      return;
    }
    if (key == 'P') {
      display_.toggle_plan();
    }
    if (key == 'C') {
      display_.toggle_slices();
    }
    if (key != 'V' || definition_.quality) {
      return;
    }
    if (!chosen_) {
      chosen_ = render::Quality::kFull;
    } else if (*chosen_ == render::Quality::kPlain) {
      chosen_ = std::nullopt;
    } else {
      chosen_ = static_cast<render::Quality>(static_cast<int>(*chosen_) - 1);
    }
  }
  std::optional<device::HandPose> hand(const device::PointerInput& input) override {
    if (!definition_.mouse.in_space || !seen_.shown) {
      return std::nullopt;
    }
    device::PointerInput free = input;
    free.pixel.x() = std::fmod(input.pixel.x(), display_.width());
    keys_.clear();
    for (const int key : input.keys) {
      if (definition_.bits_of({key}) == 0) {
        keys_.push_back(key);
      }
    }
    free.keys = keys_;
    const std::uint32_t held =
        definition_.functions_of(std::vector<int>(input.keys.begin(), input.keys.end()));
    const bool view = (held & (bone::bit(bone::Function::kCameraMove) |
                               bone::bit(bone::Function::kCameraTurn))) != 0;
    device::HandPose pose =
        hand_.follow(display_.camera(), display_.width(), display_.height(), free, seen_.tip, view);
    if (seen_.contact) {  // else a pointer far away would draw the burr through any wall
      const Eigen::Vector3d lead = pose.position - seen_.tip;
      const double leash = hand_.leash();
      pose.position = seen_.tip + leash / std::max(leash, lead.norm()) * lead;
    }
    pose.position *= definition_.drilling.scale;
    return pose;
  }

 private:
  const BoneDefinition& definition_;
  BoneDisplay display_;
  bone::DrillingView seen_;
  device::PointerHand hand_;
  std::vector<int> keys_;
  std::optional<render::Quality> chosen_;  // none: by time
  render::QualitySteps steps_;
  Clock::time_point last_{Clock::now()};
};

}  // namespace

std::shared_ptr<const bone::StructureDepths> depths_of(const bone::BoneModel& model) {
  return std::make_shared<const bone::StructureDepths>(model, bone::all_but_bone(model.structures));
}

BoneDisplay::BoneDisplay(const render::Gl& gl, const BoneDefinition& definition,
                         std::shared_ptr<const BoneStage> stage, int width, int height,
                         const render::BoneStyle& style, std::shared_ptr<bone::Surface> surface)
    : gl_(gl),
      stage_(std::move(stage)),
      surface_(std::move(surface)),
      width_(width),
      height_(height),
      scene_(gl, style, stage_->model->structures, stage_->depths),
      labels_(gl, width, height),
      hints_(definition.hints),
      vital_(definition.hints ? bone::vital_structures(*stage_->model)
                              : std::vector<std::string>{}),
      definition_(definition),
      slices_(stage_->model, pose_of(definition.placement, stage_->model->grid).inverse(),
              definition.slice_window),
      slices_shown_(definition.slices) {
  for (std::size_t tool = 0; tool < stage_->simulator->tools().size(); ++tool) {
    meshes_.push_back(mesh_of(static_cast<int>(tool)));
    const auto* driver = stage_->simulator->tools()[tool].as<bone::ScrewTool>();
    screws_.push_back(driver != nullptr ? std::make_shared<const geometry::Mesh>(
                                              render::screw_mesh(driver->diameter, driver->length))
                                        : nullptr);
  }
  if (const bone::TubeParameters* tube = stage_->simulator->tube()) {
    tube_ = std::make_shared<const geometry::Mesh>(
        render::suction_mesh(tube->outer_radius(), 2.0 * tube->radius, tube->handle_length));
  }
  set_stills(stage_->stills);
  if (definition.surroundings) {
    frame_.scenery = render::surgical_field(
        *stage_->model, pose_of(definition.placement, stage_->model->grid), stage_->start_view);
  }
  if (definition.stereo) {
    frame_.stereo = render::StereoPair{definition.eye_distance, std::nullopt};
  }
}

std::shared_ptr<const geometry::Mesh> BoneDisplay::mesh_of(int tool) const {
  const bone::ToolSpec& spec = stage_->simulator->tools()[static_cast<std::size_t>(tool)];
  const auto shared = [](geometry::Mesh mesh) {
    return std::make_shared<const geometry::Mesh>(std::move(mesh));
  };
  if (const auto* burr = spec.as<bone::BurrTool>()) {
    return shared(bone::is_saw(*burr) ? render::saw_mesh(saw_look_of(*burr, spec.handle_length))
                                      : render::burr_mesh(look_of(*burr, spec.handle_length)));
  }
  if (const auto* suction = spec.as<bone::SuctionTool>()) {
    return shared(
        render::suction_mesh(1.4 * suction->radius, 2.0 * suction->radius, spec.handle_length));
  }
  if (const auto* plane = spec.as<bone::CutPlane>()) {
    return shared(render::plane_mesh(plane->width, plane->height));
  }
  if (spec.as<bone::PlateTool>() != nullptr) {
    return shared(stage_->simulator->plate(tool)->mesh());
  }
  return shared(render::burr_mesh(1e-3, 1e-3, spec.handle_length));
}

/// The shadow of a burr or a suction tube; other tools cast none, a saw among them.
std::vector<render::Capsule> BoneDisplay::shadow_of(int tool) const {
  const bone::ToolSpec& spec = stage_->simulator->tools()[static_cast<std::size_t>(tool)];
  if (const auto* burr = spec.as<bone::BurrTool>(); burr != nullptr && !bone::is_saw(*burr)) {
    return render::burr_shadow(look_of(*burr, spec.handle_length));
  }
  if (const auto* suction = spec.as<bone::SuctionTool>()) {
    return tube_shadow(suction->radius, spec.handle_length);
  }
  return {};
}

void BoneDisplay::draw(const bone::DrillingView& seen) {
  const bone::BoneWorld& world = std::as_const(*stage_->simulator).world();
  const int pieces = world.pieces();
  frame_.bones.resize(static_cast<std::size_t>(pieces));
  world.published_poses().read(pieces, [&](int piece, const Eigen::Isometry3d& pose) {
    frame_.bones[static_cast<std::size_t>(piece)] = {
        static_cast<std::uint32_t>(piece), &world.volume(piece), pose, nullptr, {}};
  });
  if (!frame_.bones.empty()) {
    frame_.bones.front().surface = std::exchange(surface_, nullptr);
    frame_.bones.front().dents = seen.dents;
  }
  frame_.meshes.clear();
  const int plates = world.plates();
  std::vector<Eigen::Isometry3d> poses(static_cast<std::size_t>(plates));
  world.published_plates().read(plates, [&](int plate, const Eigen::Isometry3d& pose) {
    poses[static_cast<std::size_t>(plate)] = pose;
  });
  for (int plate = 0; plate < plates; ++plate) {
    if (world.plate_is_on(plate)) {
      frame_.meshes.push_back({meshes_[static_cast<std::size_t>(world.plate_model(plate))],
                               poses[static_cast<std::size_t>(plate)], kPlate});
    }
  }
  draw_screws(poses);
  if (seen.shown) {
    const auto tool = static_cast<std::size_t>(seen.tool);
    const bool plane = stage_->simulator->tools()[tool].as<bone::CutPlane>() != nullptr;
    const ToolState held{{seen.tip, Eigen::Vector3d::Zero()}, seen.orientation};
    Eigen::Isometry3d pose = render::pose_of(held);
    const auto* burr = stage_->simulator->tools()[tool].as<bone::BurrTool>();
    if (burr == nullptr || !bone::is_saw(*burr)) {
      pose.rotate(
          Eigen::AngleAxisd(2.0 * std::numbers::pi * seen.turned, Eigen::Vector3d::UnitZ()));
    }
    frame_.meshes.push_back({meshes_[tool], pose, plane ? kPlane : kSteel, shadow_of(seen.tool)});
    if (tube_ != nullptr && seen.tube.shown) {
      const ToolState other{{seen.tube.tip, Eigen::Vector3d::Zero()}, seen.tube.orientation};
      frame_.meshes.push_back({tube_, render::pose_of(other), kSteel,
                               tube_shadow(stage_->simulator->tube()->radius,
                                           stage_->simulator->tube()->handle_length)});
    }
    frame_.camera = {seen.eye, seen.target, seen.up, seen.field_of_view};
  } else {
    frame_.camera = stage_->start_view;
  }
  stage_->companions->quads(frame_.dust, dust_version_);
  if (stage_->companions->blood_quads(frame_.blood, blood_version_)) {
    constexpr float kTogether = 1.8F;  // drops are so wide that they run into each other
    for (bone::DustQuad& drop : frame_.blood) {
      drop.size *= kTogether;
    }
  }
  scene_.draw(frame_, width_, height_);
  if (seen.shown) {
    label(seen);
  }
  draw_still(seen.stills_asked);
  draw_plan(seen);
  draw_slices(seen);
}

/// Screws in plates that are on, with their heads on the plates. @param plates  their poses, X_WP
void BoneDisplay::draw_screws(const std::vector<Eigen::Isometry3d>& plates) {
  const bone::Simulator& simulator = *stage_->simulator;
  const bone::BoneWorld& world = simulator.world();
  for (int number = 0; number < simulator.screws().count(); ++number) {
    const bone::ScrewPlace at = simulator.screws().place(number);
    if (at.plate < static_cast<int>(plates.size()) && world.plate_is_on(at.plate)) {
      const auto& holes = simulator.plate(world.plate_model(at.plate))->holes();
      const Eigen::Isometry3d hole = holes[static_cast<std::size_t>(at.hole)] *
                                     Eigen::Translation3d(0.0, 0.0, bone::PlateShape{}.thickness);
      frame_.meshes.push_back({screws_[static_cast<std::size_t>(at.tool)],
                               plates[static_cast<std::size_t>(at.plate)] * hole, kSteel});
    }
  }
}

void BoneDisplay::label(const bone::DrillingView& seen) {
  const bone::ToolSpec& tool = stage_->simulator->tools()[static_cast<std::size_t>(seen.tool)];
  const std::vector<std::string> hints = hints_in(seen);
  const double left_over = (1.0 - seen.progress) * seen.time_limit;
  const std::string clock =
      seen.time_limit > 0.0 ? with(definition_.time_text, "{time}", clock_time(left_over)) : "";
  for (int left = 0; left < width_; left += width()) {
    labels_.tool(words_of(tool, seen), {left, width()});
    labels_.clock(clock, {left, width()});
    labels_.hints(hints, {left, width()});
  }
  show_injury(seen);
}

/// A vital structure was just opened: a red frame that fades, and words that stay longer.
void BoneDisplay::show_injury(const bone::DrillingView& seen) {
  constexpr double kFrame = 1.0;  // [s]
  constexpr double kWords = 5.0;  // [s]
  if (seen.injury.label == 0 || seen.injury.since > kWords) {
    return;
  }
  const double when = seen.elapsed - seen.injury.since;
  std::string words = with(definition_.opened_text, "{time}", clock_time(when));
  words = with(std::move(words), "{structure}", stage_->model->structures[seen.injury.label].name);
  for (int left = 0; left < width_; left += width()) {
    labels_.injury(words, 1.0 - seen.injury.since / kFrame, {left, width()});
  }
}

std::vector<std::string> BoneDisplay::hints_in(const bone::DrillingView& seen) const {
  std::vector<std::string> lines;
  const auto at = static_cast<std::size_t>(seen.hint_structure);
  const std::string structure =
      seen.hint_structure >= 0 && at < vital_.size() ? vital_[at] : std::string();
  for (const hint::HintKind kind : hint::kAllHintKinds) {
    if (hints_ && (seen.hints & hint::bit(kind)) != 0) {
      lines.push_back(hint::hint_text(*hints_, kind, structure));
    }
  }
  return lines;
}

void BoneDisplay::set_stills(std::shared_ptr<const std::vector<render::Image>> stills) {
  const bool any = stills != nullptr && !stills->empty();
  stills_ = any ? std::make_unique<render::BoneStills>(gl_, std::move(stills)) : nullptr;
}

/// Draws none, the first, ..., the last, none.
void BoneDisplay::draw_still(std::int32_t asked) {
  const std::size_t number = stills_ ? static_cast<std::size_t>(asked) % (stills_->count() + 1) : 0;
  if (number == 0) {
    return;
  }
  const int eyes = frame_.stereo ? 2 : 1;
  for (int eye = 0; eye < eyes; ++eye) {
    stills_->draw(number - 1, eye * (width_ / eyes), width_ / eyes, height_);
  }
}

void BoneDisplay::toggle_plan() {
  if (!plan_ && definition_.cavity) {
    plan_ = std::make_unique<PlanSection>(definition_, stage_->model);
  }
  plan_shown_ = plan_ && !plan_shown_;
}

void BoneDisplay::draw_plan(const bone::DrillingView& seen) {
  constexpr int kFrames = 10;  // between two sections
  if (!plan_shown_) {
    return;
  }
  if (!plan_picture_ || ++plan_age_ >= kFrames) {
    const auto& volume = std::as_const(*stage_->simulator).world().volume(0);
    if (const auto section = plan_->at(volume, seen.shown ? seen.tip : stage_->start_view.target)) {
      plan_age_ = 0;
      if (!plan_picture_) {
        plan_picture_ = std::make_unique<render::BoneStills>(gl_, section);
      } else {
        plan_picture_->replace(section);
      }
    }
  }
  if (plan_picture_) {
    const Eigen::Vector4d place = plan_picture_->place(width(), height_);
    for (int left = 0; left < width_; left += width()) {
      plan_picture_->draw(0, left, width(), height_);
      labels_.legend(definition_.plan_text, place.y() + place.w(), {left, width()});
    }
  }
}

void BoneDisplay::draw_slices(const bone::DrillingView& seen) {
  if (!slices_shown_) {
    return;
  }
  const auto& volume = std::as_const(*stage_->simulator).world().volume(0);
  const auto picture = slices_.at(volume, seen.shown ? seen.tip : stage_->start_view.target);
  if (!slices_picture_) {
    slices_picture_ = std::make_unique<render::BoneStills>(gl_, picture, render::StillSide::kLeft);
  } else {
    slices_picture_->replace(picture);
  }
  for (int left = 0; left < width_; left += width()) {
    slices_picture_->draw(0, left, width(), height_);
  }
}

std::shared_ptr<bone::Surface> built_surface(const BoneStage& stage,
                                             const geometry::WorkReport& report) {
  auto surface = std::make_shared<bone::Surface>(stage.depths);
  surface->build(std::as_const(*stage.simulator).world().volume(0), report);
  return surface;
}

MakeDrawing bone_drawing(const BoneDefinition& definition, std::shared_ptr<const BoneStage> stage,
                         std::shared_ptr<bone::Surface> surface) {
  const auto built = std::make_shared<std::shared_ptr<bone::Surface>>(std::move(surface));
  return [&definition, stage, built](const render::Gl& gl, int width, int height) {
    return std::make_unique<BoneDrawing>(gl, definition, stage, width, height,
                                         std::exchange(*built, nullptr));
  };
}

}  // namespace haptrial::protocols
