#include "protocols/psychophysics/definition/handle_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/control/loop_margin.h"
#include "core/scene/needed_damping.h"
#include "protocols/psychophysics/definition/presented.h"

namespace haptrial::protocols {
namespace {

bool acts(std::uint64_t mask, std::size_t field) { return (mask >> field & 1U) != 0; }

std::vector<scene::Field> those_of(std::uint64_t mask, const std::vector<scene::Field>& fields) {
  std::vector<scene::Field> those;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (acts(mask, i)) {
      those.push_back(fields[i]);
    }
  }
  return those;
}

/// Forces of less than this swing to and fro by less than what counts as an oscillation, 1.5 N [N].
constexpr double kWeak = 0.75;

/// How hard a surface can be pressed [N].
double most_press(const std::vector<scene::Field>& fields, const std::string& surface) {
  const auto found = std::ranges::find(fields, surface, &scene::Field::name);
  return found != fields.end() ? found->limit : 0.0;
}

/// On a surface the level of friction is a coefficient.
bool is_weak_friction(const std::vector<scene::Field>& fields, const scene::Field& field) {
  const auto* friction = std::get_if<scene::FrictionParameters>(&field.kind);
  if (friction == nullptr) {
    return false;
  }
  const double press = friction->on.empty() ? 1.0 : most_press(fields, friction->on);
  return std::min(friction->static_level * press, field.limit) < kWeak;
}

/// Hands that explore or press are seldom faster [m/s].
constexpr double kOwnSpeed = 0.1;

/// The press of a hand that feels how rough a surface is [N].
constexpr double kPress = 3.0;

/// Ridges on a surface as a hand that rests on them feels them.
struct Ridges {
  double slope{0.0};  // s
  double hold{0.0};   // F c, with which a groove holds the hand [N/m]
  double left{0.0};   // of the surface's limit, with ridges as steep as anywhere [N]

  bool felt() const { return hold > 0.0; }
};

/// @param height  share of the ridges' own
Ridges ridges_on(const std::vector<scene::Field>& fields, const scene::Field& surface,
                 double height) {
  const scene::ReliefBound reliefs = scene::reliefs_on(fields, surface);
  const double slope = height * reliefs.usual_slope;
  const double left = surface.limit / (1.0 + height * reliefs.slope);
  const double press = std::min(kPress, left);
  return press * slope < kWeak ? Ridges{0.0, 0.0, left}
                               : Ridges{slope, press * height * reliefs.usual_curvature, left};
}

/// Bound on a field for a hand that rests on it. The energy phi(e) of a surface, e = depth + h, has
/// the second derivative k g gᵀ + F h'' with g = n - ∇h, so that
///
///     K = k (1 + s²) + F c,   B = b (1 + s²).
scene::StiffnessBound bound_at_rest(const scene::Field& field, const Ridges& ridges) {
  scene::StiffnessBound bound =
      std::visit([](const auto& kind) { return kind.bound(); }, field.kind);
  const double lean = 1.0 + ridges.slope * ridges.slope;
  bound.stiffness = lean * bound.stiffness + ridges.hold;
  bound.damping *= lean;
  return bound;
}

}  // namespace

HandleReport::HandleReport(const TrialsDefinition& definition)
    : d_(definition), arms_(definition.arms()), beginnings_(definition) {}

HandleReport::Load HandleReport::load_of(const Presented& presented, std::size_t stage,
                                         std::size_t device, double height) const {
  const NamedStage& named = presented.stages[stage];
  const std::vector<scene::Field> fields =
      those_of(named.stage.fields & presented.felt[device], presented.fields);
  Load load;
  load.stage = named.name;
  load.device = device;
  for (const scene::Field& field : fields) {
    if (is_weak_friction(fields, field)) {
      continue;
    }
    const Ridges ridges = ridges_on(fields, field, height);
    const scene::StiffnessBound bound = bound_at_rest(field, ridges);
    load.ridged = load.ridged || ridges.felt();
    if (field.limit - ridges.left > load.taken) {
      load.taken = field.limit - ridges.left;
      load.left = ridges.left;
      load.surface = field.name;
    }
    load.stiffness += std::isfinite(bound.stiffness) ? bound.stiffness : 0.0;
    load.damping += bound.damping;
    load.driving += bound.driving;
    const scene::FieldTraits traits = scene::traits_of(field);
    load.mass += traits.mass;
    load.cutoff = std::max(load.cutoff, traits.mass_cutoff);
  }
  return load;
}

/// The loop of the device, with what it has in its handle's place.
control::HandleLoop HandleReport::loop_of(const Load& load) const {
  control::HandleLoop loop = handle_loop(d_);
  loop.handle_mass = arms_[load.device].handle_mass.value_or(loop.handle_mass);
  loop.force_delay = d_.force_delay(load.device);
  return loop;
}

/// The beginning of a sentence.
std::string HandleReport::where(const Load& load) const {
  return arms_.size() == 1
             ? fmt::format("stage {}: its fields", load.stage)
             : fmt::format("stage {}: its fields on {}", load.stage, arms_[load.device].name);
}

std::string HandleReport::sum_of(const Load& load) const {
  return fmt::format("{}{} add up to {}", where(load), load.ridged ? " and the ridges on them" : "",
                     amount_of(load));
}

std::string HandleReport::damping_text(const Load& load, double damping) const {
  Load alone;
  alone.device = load.device;
  alone.damping = damping;
  return amount_of(alone);
}

bool HandleReport::by_fingers(const Load& load) const {
  return arms_[load.device].part != device::Part::kTip;
}

/// The heaviest hand, or fingers, that a load may need [kg].
double HandleReport::heaviest(const Load& load) const {
  return by_fingers(load) ? control::kHeaviestFingers : control::kHeaviestHand;
}

/// The guard leaves alone what swings no faster than a hand that trembles. With the hands of most
/// people such swings reach 2 N only where even a heavy hand does not carry the load.
/// @throws InputError if it is such a load
void HandleReport::reject_slow_swings(const Load& load, const control::HandleLoop& loop) const {
  constexpr double kTremor = 12.0;    // [Hz]
  constexpr double kHeavyHand = 0.6;  // [kg]
  if (load.lightest < kHeavyHand) {
    return;
  }
  const double frequency = control::dominant_frequency({load.stiffness, load.damping}, loop,
                                                       control::held_by_hand(0.98 * load.lightest));
  if (frequency <= kTremor) {
    throw InputError(fmt::format(
        "{}; at {:g} Hz, with forces that come {} late, hands of less than {:.2f} kg oscillate "
        "with them at {:.1f} Hz, which cannot be told from a tremor; allowed: less of it, or a "
        "faster loop",
        sum_of(load), d_.rate, control::ticks_in_words(loop.force_delay), load.lightest,
        frequency));
  }
}

/// @throws InputError if no hand carries it, or one swings with it as slowly as a tremor
void HandleReport::judge(Load& load, const LoadOf& of_height) const {
  const control::HandleLoop loop = loop_of(load);
  const control::PdGains gains{load.stiffness, load.damping};
  const auto mass_carried_by = [&](double hand) {
    return load.mass == 0.0 ||
           load.mass <
               scene::largest_stable_mass(load.cutoff, {loop.handle_mass + hand, loop.rate,
                                                        loop.velocity_window, loop.force_delay});
  };
  load.lightest = control::lightest_calm_hand(gains, loop);
  if (load.lightest > heaviest(load) || !mass_carried_by(heaviest(load))) {
    const std::string lower = lower_ridges(load, of_height, control::held_by_hand(heaviest(load)));
    throw InputError(fmt::format(
        "{}; no {} of up to {:g} kg {} that at {:g} Hz, with forces that come {} late; "
        "allowed: less of it, or a faster loop{}{}",
        sum_of(load), by_fingers(load) ? "fingers" : "hand", heaviest(load),
        by_fingers(load) ? "carry" : "carries", d_.rate, control::ticks_in_words(loop.force_delay),
        lower.empty() ? "" : ", or ", lower));
  }
  reject_slow_swings(load, loop);
  constexpr double kStep = 0.01;  // [kg]
  while (!mass_carried_by(load.lightest)) {
    load.lightest += kStep;
  }
  const control::HeldBy own{d_.hand.hand_mass, d_.hand.damping, d_.hand.stiffness};
  load.own_hand = control::is_calm(gains, loop, own) && mass_carried_by(d_.hand.hand_mass);
  load.lower = load.own_hand ? "" : lower_ridges(load, of_height, own);
}

/// How high ridges may be for a hand; empty if not even flat fields are for it.
std::string HandleReport::lower_ridges(const Load& load, const LoadOf& of_height,
                                       const control::HeldBy& hand) const {
  const control::HandleLoop loop = loop_of(load);
  const auto carried = [&](double height) {
    const Load lower = of_height(height);
    return control::is_calm({lower.stiffness, lower.damping}, loop, hand);
  };
  if (!load.ridged || !carried(0.0)) {
    return "";
  }
  int low = 0, high = 100;  // of a hundred
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    (carried(0.01 * middle) ? low : high) = middle;
  }
  return fmt::format("ridges of at most {} % of their height", low);
}

std::string HandleReport::amount_of(const Load& load) const {
  std::vector<std::string> parts;
  const auto add = [&](double amount, const char* unit) {
    if (amount > 0.0) {
      parts.push_back(fmt::format("{} {}", std::round(10.0 * amount) / 10.0, unit));
    }
  };
  const DeviceArm& arm = arms_[load.device];
  if (arm.part == device::Part::kRotation) {
    const double square = arm.radius * arm.radius;
    const auto add_small = [&](double amount, const char* unit) {
      if (amount > 0.0) {
        parts.push_back(fmt::format("{:.3g} {}", square * amount, unit));
      }
    };
    add_small(load.stiffness, "N·m/rad");
    add_small(load.damping, "N·m·s/rad");
    add_small(load.mass, "kg·m² of virtual inertia");
  } else {
    add(load.stiffness, "N/m");
    add(load.damping, "N·s/m");
    add(load.mass, "kg of virtual mass");
  }
  return fmt::format("{}", fmt::join(parts, " and "));
}

void HandleReport::keep(const Load& load, double Load::*demand, std::vector<Load>& kept) {
  const auto said = std::ranges::find_if(kept, [&](const Load& other) {
    return other.stage == load.stage && other.device == load.device;
  });
  if (said == kept.end()) {
    kept.push_back(load);
  } else if (load.*demand > (*said).*demand) {
    *said = load;
  }
}

/// The guard leaves such forces alone, as they swing no faster than hands move.
/// @throws InputError if no hand damps as much
void HandleReport::note_driving(const Load& load) {
  constexpr double kHardly = 0.1;  // [N·s/m]
  if (load.driving < kHardly) {
    return;
  }
  const double most = control::held_by_hand(heaviest(load)).damping;
  if (load.driving > most) {
    throw InputError(fmt::format(
        "{} push movements on with up to {}, and {} of up to {:g} kg damp no more than {}, so that "
        "they swing up by themselves; allowed: less of it; the matrix of a damper is negative, as "
        "f = B v",
        where(load), damping_text(load, load.driving), by_fingers(load) ? "fingers" : "hands",
        heaviest(load), damping_text(load, most)));
  }
  keep(load, &Load::driving, driving_);
}

/// A force that follows the hand too slowly is still there when the hand has left its field.
void HandleReport::note_late(const Load& load) {
  if (load.stiffness * kOwnSpeed > arms_[load.device].limits.max_force_rate) {
    keep(load, &Load::stiffness, late_);
  }
}

/// Ridges push aside, too, and the whole force stays within the limit: less is left against a
/// press.
void HandleReport::note_taken(const Load& load) {
  if (load.taken > load.left) {
    keep(load, &Load::taken, taken_);
  }
}

/// A damper feels the steps of a coarse encoder. @returns the force of one [N]
double HandleReport::knock_of(const Load& load) const {
  return load.damping * loop_of(load).velocity_step;
}

void HandleReport::note_knocks(const Load& load) {
  constexpr double kFelt = 0.5;  // [N]
  if (knock_of(load) > kFelt) {
    keep(load, &Load::damping, knocks_);
  }
}

void HandleReport::note_stiffest(const Load& load) {
  const DeviceArm& arm = arms_[load.device];
  const bool turns = arm.part == device::Part::kRotation;
  const double stiffness = load.stiffness * (turns ? arm.radius * arm.radius : 1.0);
  StiffestStage& most = felt_[static_cast<std::size_t>(arm.part)].stiffest;
  if (stiffness > most.stiffness) {
    most = {load.stage, stiffness};
  }
}

void HandleReport::add(Load load, const LoadOf& of_height) {
  note_stiffest(load);
  note_driving(load);
  note_late(load);
  note_taken(load);
  note_knocks(load);
  if (load.stiffness == 0.0 && load.damping == 0.0 && load.mass == 0.0) {
    return;
  }
  const auto same = std::find_if(judged_.begin(), judged_.end(), [&](const Load& other) {
    return other.device == load.device && other.stiffness == load.stiffness &&
           other.damping == load.damping && other.mass == load.mass && other.cutoff == load.cutoff;
  });
  if (same == judged_.end()) {
    judge(load, of_height);
    judged_.push_back(load);
  } else {
    load.lightest = same->lightest;
    load.own_hand = same->own_hand;
    load.lower = same->lower;
  }
  if (load.lightest > 0.0 || !load.own_hand) {
    keep(load, &Load::lightest, worst_);
  }
}

void HandleReport::add(const Presented& presented) {
  for (std::size_t stage = 0; stage < presented.stages.size(); ++stage) {
    for (std::size_t device = 0; device < arms_.size(); ++device) {
      const bool felt = (presented.stages[stage].stage.fields & presented.felt[device]) != 0;
      felt_[static_cast<std::size_t>(arms_[device].part)].felt |= felt;
      const auto of_height = [&](double height) {
        return load_of(presented, stage, device, height);
      };
      add(of_height(1.0), of_height);
    }
  }
  beginnings_.add(presented);
}

/// The end of a sentence; empty where a handle that nobody holds carries all of it, if barely.
std::string HandleReport::left_on_bare_handle(const Load& load) const {
  const control::BareHandle bare =
      control::bare_handle({load.stiffness, load.damping}, loop_of(load));
  const DeviceArm& arm = arms_[load.device];
  const bool turns = arm.part == device::Part::kRotation;
  const double square = turns ? arm.radius * arm.radius : 1.0;
  std::vector<std::string> less;
  if (load.damping > bare.damping) {
    less.push_back(turns ? fmt::format(" of the damping {:.2g} N·m·s/rad", square * bare.damping)
                         : fmt::format(" of the damping {:.1f} N·s/m", bare.damping));
  }
  if (load.stiffness > bare.stiffness) {
    less.push_back(turns ? fmt::format(" of the stiffness {:.2g} N·m/rad", square * bare.stiffness)
                         : fmt::format(" of the stiffness {:.0f} N/m", bare.stiffness));
  }
  if (load.mass > 0.0) {
    less.emplace_back(" of the virtual mass what it carries");
  }
  return less.empty() ? ""
                      : fmt::format(", for a handle that nobody holds to:{}", fmt::join(less, ","));
}

/// Words about stages whose forces hands carry, but that are felt otherwise than they seem.
void HandleReport::add_words_of_use(HandleText& words) const {
  for (const Load& load : driving_) {
    words.warnings.push_back(fmt::format(
        "{} push movements on with up to {}: hands that damp less swing up by themselves (that of "
        "[hand] damps {}), and a handle that nobody holds runs away",
        where(load), damping_text(load, load.driving), damping_text(load, d_.hand.damping)));
  }
  for (const Load& load : taken_) {
    (load.left < kPress ? words.warnings : words.lines)
        .push_back(fmt::format(
            "stage {}: ridges leave {} {:.3g} N of its limit of {:g} N, and a hand that presses "
            "harder falls through; a higher limit or lower ridges leave more",
            load.stage, load.surface, load.left, load.left + load.taken));
  }
  for (const Load& load : knocks_) {
    words.warnings.push_back(fmt::format(
        "{}: with device.position_quantum of {:g} m and device.velocity_window of {} ms each step "
        "of the virtual device's encoder is a knock of {:.2g} N; a longer window, a finer quantum "
        "or less damping avoids them",
        sum_of(load), d_.device.position_quantum, d_.device.velocity_window, knock_of(load)));
  }
  for (const Load& load : late_) {
    const double rate = arms_[load.device].limits.max_force_rate;
    words.warnings.push_back(fmt::format(
        "{}, and max_force_rate lets them follow a hand of at most {:.2g} m/s: a faster one is "
        "pushed where nothing is; set it to {:g} N/s or more",
        sum_of(load), rate / load.stiffness, std::ceil(kOwnSpeed * load.stiffness)));
  }
}

HandleText HandleReport::words() const {
  HandleText words;
  words.lines = beginnings_.lines();
  for (const Load& load : worst_) {
    words.lines.push_back(
        fmt::format("{}, which hands of {:.2f} kg or more carry; for lighter ones haptrial reduces "
                    "them{}",
                    sum_of(load), load.lightest, left_on_bare_handle(load)));
    if (!load.own_hand) {
      words.warnings.push_back(fmt::format(
          "{}, which only hands of {:.2f} kg or more carry at {:g} Hz; the hand of [hand] has {:g} "
          "kg, so that they are reduced in most trials{}{}",
          sum_of(load), load.lightest, d_.rate, d_.hand.hand_mass,
          load.lower.empty() ? "" : "; it carries ", load.lower));
    }
  }
  add_words_of_use(words);
  for (const std::string& warning : certificate_warnings(d_, felt_)) {
    words.warnings.push_back(warning);
  }
  return words;
}

}  // namespace haptrial::protocols
