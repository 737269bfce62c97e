#include "core/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <variant>

#include "core/base/require.h"
#include "core/control/pd_controller.h"
#include "core/scene/fade.h"

namespace haptrial::scene {
namespace {

using Eigen::Vector3d;

using Law =
    std::variant<Constant, Ramp, Pulse, Measured, Hold, Surface, Grating, Texture, Viscous, Inertia,
                 Friction, SineVibration, NoiseVibration, Tap, Detent, Click, Mover, PathGuide,
                 CurveHold, RigidObject, DeformableObject, RegisteredField>;

template <class Each>
concept SurfaceLaw = requires(Each& law) {
  law.lay(ReliefHere{});
};

void lay_on(Law& law, const ReliefHere& relief) noexcept {
  std::visit(
      [&](auto& each) {
        if constexpr (SurfaceLaw<std::decay_t<decltype(each)>>) {
          each.lay(relief);
        }
      },
      law);
}

/// A law that is no surface is touched nowhere.
SurfaceTouch touch_of(const Law& law) noexcept {
  return std::visit(
      [](const auto& each) -> SurfaceTouch {
        if constexpr (SurfaceLaw<std::decay_t<decltype(each)>>) {
          return each.touch();
        } else {
          return {};
        }
      },
      law);
}

/// Whether two reliefs have the same heights everywhere; true of laws that are no reliefs.
bool same_relief(const Law& a, const Law& b) noexcept {
  return std::visit(
      [&](const auto& own) {
        using Same = std::decay_t<decltype(own)>;
        if constexpr (std::is_same_v<Same, Grating> || std::is_same_v<Same, Texture>) {
          return own == *std::get_if<Same>(&b);
        }
        return true;
      },
      a);
}

Law law_of(const Field& field, const Setting& setting) {
  return std::visit(
      [&](const auto& parameters) -> Law {
        return typename std::decay_t<decltype(parameters)>::Law(parameters, setting);
      },
      field.kind);
}

constexpr std::size_t kFreeSpace = Scene::kMostFields;

/// The index of the surface that `field` lies on.
std::size_t index_of_surface(const std::vector<Field>& fields, const Field& field) {
  const std::string& name = surface_of(field);
  if (name.empty()) {
    if (traits_of(field).relief) {
      throw std::invalid_argument("Scene: " + field.name + " must lie on a surface");
    }
    return kFreeSpace;
  }
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (fields[i].name == name && traits_of(fields[i]).surface) {
      return i;
    }
  }
  throw std::invalid_argument("Scene: " + field.name + " lies on " + name +
                              ", which is not a surface of the scene");
}

}  // namespace

struct Scene::Part {
  Law law;
  std::size_t kind;  // index in FieldKind
  bool surface;      // others may lie on it
  bool timed;        // its force has a course in time
  double limit;
  double fade_in;
  double fade_out;
  std::size_t on;  // index of a surface, or kFreeSpace
  Fade fade{};
  bool begins{false};
  double time{0.0};
  ReliefHere relief{};     // of a surface
  PassingWatch passing{};  // of a relief
  FieldState state{};
  bool other_relief{false};                  // its heights changed with this tick
  Vector3d stimulus_before{Vector3d::Zero()};  // of the last tick, if the field goes on [N]
  Part* before{nullptr};  // of the scene before, until it is known what acts in this one
  Part* lender{nullptr};  // of a scene before, whose law fades out here; has this part's own

  /// Fades out as it was felt: with the law of the scene before, not with the numbers to come.
  void keep_law() noexcept {
    Part* from = std::exchange(before, nullptr);
    if (from != nullptr && acts()) {
      swap_law(*from);
      lender = from;
    }
  }
  /// Acts, and so with its own numbers; its contact and filters go on.
  void take_own_law() noexcept {
    if (Part* from = std::exchange(before, nullptr)) {
      adopt_law(*from);
      other_relief = !same_relief(law, from->law);
    }
    if (Part* has_own = std::exchange(lender, nullptr)) {
      swap_law(*has_own);
      adopt_law(*has_own);
      other_relief = !same_relief(law, has_own->law);
    }
  }
  void swap_law(Part& other) noexcept {
    law.swap(other.law);
    std::swap(limit, other.limit);
    std::swap(fade_in, other.fade_in);
    std::swap(fade_out, other.fade_out);
  }
  void adopt_law(Part& other) noexcept {
    std::visit(
        [&](auto& own) {
          using Same = std::decay_t<decltype(own)>;
          if constexpr (requires(Same & same) { own.adopt(same); }) {
            own.adopt(*std::get_if<Same>(&other.law));
          }
        },
        law);
  }

  bool acts() const noexcept { return fade.on() || !fade.over(); }

  void begin(const PointState& hand) noexcept {
    begins = false;
    time = 0.0;
    std::visit(
        [&](auto& each) {
          if constexpr (requires { each.start(hand); }) {
            each.start(hand);
          }
        },
        law);
  }
};

Scene::Scene(const std::vector<Field>& fields, double rate) : period_(1.0 / rate), way_(rate) {
  require(std::isfinite(rate) && rate > 0.0, "Scene: rate must be finite and above 0");
  require(fields.size() <= kMostFields, "Scene: at most 64 fields");
  parts_.reserve(fields.size());
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const Field& field = fields[i];
    try {
      require(std::none_of(fields.begin(), fields.begin() + static_cast<std::ptrdiff_t>(i),
                           [&](const Field& other) { return other.name == field.name; }),
              "its name occurs twice");
      require(std::isfinite(field.limit) && field.limit > 0.0, "limit must be finite and above 0");
      require(std::isfinite(field.fade_in) && field.fade_in >= 0.0,
              "fade_in must be finite and at least 0");
      require(std::isfinite(field.fade_out) && field.fade_out >= 0.0,
              "fade_out must be finite and at least 0");
      parts_.push_back({law_of(field, {field.limit, rate}), field.kind.index(),
                        traits_of(field).surface, traits_of(field).timed, field.limit,
                        field.fade_in, field.fade_out, index_of_surface(fields, field)});
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("field " + field.name + ": " + error.what());
    }
    const FieldTraits traits = traits_of(field);
    (traits.relief ? reliefs_ : traits.surface ? surfaces_ : forces_).push_back(i);
  }
  forces_.insert(forces_.begin(), surfaces_.begin(), surfaces_.end());
}

Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

void Scene::switch_to(std::uint64_t mask) noexcept {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    Part& part = parts_[i];
    const bool on = (mask >> i & 1u) != 0;
    on ? part.take_own_law() : part.keep_law();
    if (on == part.fade.on()) {
      continue;
    }
    if (on && (part.timed || !part.acts())) {
      part.begins = true;
      part.state = {.stimulus = part.state.stimulus};
      part.fade = {};
    }
    part.fade.turn(on, on ? part.fade_in : part.fade_out);
  }
}

void Scene::switch_off(double longest) noexcept {
  switch_to(0);
  for (Part& part : parts_) {
    if (part.fade.left() > longest) {
      part.fade.turn(false, longest);
    }
  }
}

void Scene::restart_with(std::uint64_t mask) noexcept {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (parts_[i].timed && (mask >> i & 1u) != 0) {
      parts_[i].fade = {};
    }
  }
  switch_to(mask);
}

void Scene::start_from(Scene& before) noexcept {
  before_ = before.before_;
  share_ = before.share_;
  way_.adopt(before.way_);
  const std::size_t shared = std::min(parts_.size(), before.parts_.size());
  for (std::size_t i = 0; i < shared; ++i) {
    Part& part = parts_[i];
    Part& old = before.parts_[i];
    if (part.kind != old.kind) {
      continue;
    }
    part.before = &old;
    part.fade = old.fade;
    part.begins = old.begins;
    part.time = old.time;
    part.state = old.state;
    part.passing = old.passing;
  }
}

void Scene::lay_reliefs(const Vector3d& p, const Vector3d& ahead) noexcept {
  for (const std::size_t i : surfaces_) {
    parts_[i].relief = {};
  }
  for (const std::size_t i : reliefs_) {
    Part& part = parts_[i];
    if (!part.acts() || !parts_[part.on].acts()) {
      continue;
    }
    ReliefHere& relief = parts_[part.on].relief;
    const auto lay = [&](const auto& law) {
      law.add(p, part.fade.weight(), relief, part.state);
      relief.passes |= part.passing.look(law.ridges(ahead), period_);
      relief.changed |= std::exchange(part.other_relief, false);
    };
    if (const auto* grating = std::get_if<Grating>(&part.law)) {
      lay(*grating);
    } else if (const auto* texture = std::get_if<Texture>(&part.law)) {
      lay(*texture);
    }
  }
  for (const std::size_t i : surfaces_) {
    lay_on(parts_[i].law, parts_[i].relief);
  }
}

/// @param common  to all fields
void Scene::feel(Part& part, const Felt& common) noexcept {
  SurfaceTouch touch;
  Felt felt = common;
  felt.time = part.time;
  if (part.on != kFreeSpace) {
    const Part& surface = parts_[part.on];
    if (surface.acts()) {
      touch = touch_of(surface.law);
      touch.pressing *= surface.fade.weight();
    }
    felt.surface = &touch;
  }
  FieldState& state = part.state;
  state.limited = false;
  state.stimulus.setZero();
  Vector3d force = std::visit(
      [&](auto& law) -> Vector3d {
        if constexpr (requires { law.force(felt, state); }) {
          return law.force(felt, state);
        } else {
          return Vector3d::Zero();
        }
      },
      part.law);
  const double size = force.norm();
  state.limited = state.limited || size > part.limit;
  if (!part.surface) {
    state.contact = size > 0.0;
  }
  const double passed = part.fade.weight() * (size > part.limit ? part.limit / size : 1.0);
  state.force = passed * force;
  state.stimulus *= passed;
  state.max_force = std::max(state.max_force, part.fade.weight() * std::min(size, part.limit));
  store(part, felt.shares.stiffness);
}

/// The energy of the springs that the hand loads, and what of it comes from their stiffness alone.
void Scene::store(Part& part, double share) noexcept {
  FieldState& state = part.state;
  std::visit(
      [&](const auto& law) {
        if constexpr (requires { law.stored(state.depth, share); }) {
          state.stored = part.fade.weight() * law.stored(state.depth, share);
          state.added = state.stored - part.fade.weight() * law.stored(state.depth, share_);
        }
      },
      part.law);
}

Vector3d Scene::force(const PointState& hand, const control::GainShares& shares,
                      std::span<const double> channels) noexcept {
  ended_.setZero();
  if (!hand.position.allFinite() || !hand.velocity.allFinite()) {
    return Vector3d::Zero();
  }
  for (Part& part : parts_) {
    if (part.before != nullptr) {
      part.take_own_law();  // nothing was switched since start_from()
    }
    part.state.work += part.state.force.dot(hand.position - before_);
    part.state.weight = part.fade.weight();
    part.state.force.setZero();
    const bool ends = part.begins || !part.acts();
    ended_ += ends ? part.state.stimulus : Vector3d(Vector3d::Zero());
    part.stimulus_before = ends ? Vector3d(Vector3d::Zero()) : part.state.stimulus;
    part.state.stimulus.setZero();
    part.state.stored = part.state.added = 0.0;
    if (!part.acts()) {
      part.state.contact = part.state.limited = part.state.sliding = false;
    }
    if (part.begins) {
      part.begin(hand);
    }
  }
  before_ = hand.position;
  lay_reliefs(hand.position, way_.next(hand.velocity));
  const Felt common{hand, 0.0, nullptr, shares, channels};
  Vector3d sum = Vector3d::Zero();
  for (const std::size_t i : forces_) {
    if (parts_[i].acts()) {
      feel(parts_[i], common);
      sum += parts_[i].state.force;
    }
  }
  end_stimuli_of_reliefs();
  for (Part& part : parts_) {
    if (part.acts()) {
      part.state.max_depth = std::max(part.state.max_depth, part.state.depth);
      part.time += period_;
      part.fade.next(period_);
    }
  }
  share_ = shares.stiffness;
  return sum;
}

/// Ridges under a moving hand are a stimulus of the surface, which goes on when they end or become
/// others.
void Scene::end_stimuli_of_reliefs() noexcept {
  for (const std::size_t i : surfaces_) {
    const Part& part = parts_[i];
    if (part.relief.changed) {
      ended_ += part.stimulus_before - part.state.stimulus;
    } else if (!part.relief.passes) {
      ended_ += part.stimulus_before;
    }
  }
}

void Scene::forget_extremes() noexcept {
  for (Part& part : parts_) {
    part.state.max_depth = part.state.max_force = part.state.work = 0.0;
  }
}

std::size_t Scene::size() const noexcept { return parts_.size(); }

std::uint64_t Scene::mask() const noexcept {
  std::uint64_t mask = 0;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    mask |= std::uint64_t{parts_[i].fade.on()} << i;
  }
  return mask;
}

const FieldState& Scene::state(std::size_t field) const noexcept { return parts_[field].state; }

const deformable::BodyTouch* Scene::touch(std::size_t field) const noexcept {
  const auto* body = std::get_if<DeformableObject>(&parts_[field].law);
  return body != nullptr ? body->touch() : nullptr;
}

double Scene::energy(const Vector3d& p) noexcept {
  lay_reliefs(p, Vector3d::Zero());
  double sum = 0.0;
  for (const Part& part : parts_) {
    std::visit(
        [&](const auto& law) {
          if constexpr (requires { law.energy(p); }) {
            sum += part.fade.weight() * law.energy(p);
          }
        },
        part.law);
  }
  return sum;
}

}  // namespace haptrial::scene
