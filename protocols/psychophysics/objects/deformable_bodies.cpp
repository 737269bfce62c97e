#include "protocols/psychophysics/objects/deformable_bodies.h"

#include <fmt/format.h>

#include <cmath>

#include "core/deformable/touch/prepared.h"
#include "core/deformable/touch/tissue.h"
#include "core/deformable/touch/touch_cost.h"
#include "core/scene/needed_damping.h"

namespace haptrial::protocols {

namespace {

constexpr double kMicroseconds = 1e6;

std::string words_of_cost(const std::string& name, const deformable::TouchCost& cost, double rate) {
  return fmt::format(
      "objects.{}: a tick in contact takes {:.0f} µs in the median and less than {:.0f} µs in 99 "
      "of 100 (measured now, on this machine), of {:.0f} µs at {:g} Hz",
      name, kMicroseconds * cost.median, kMicroseconds * cost.most, kMicroseconds / rate, rate);
}

/// Words about elements that rest on every tick.
void add_words_of_elements(const scene::Field& field, const scene::DeformableObjectParameters& p,
                           const scene::StiffnessBound& bound, double rate, double damping,
                           std::vector<std::string>& lines) {
  const double needed = scene::needed_damping_below(0.0, bound, rate);
  const double most = deformable::stiffest_touch(*p.body, p.tool.radius);
  const double under = p.body->stiffest(p.tool.radius);
  const deformable::ComplianceMemory memory = deformable::compliance_memory(*p.mesh);
  // Infinite where the ball reaches what is held.
  const std::string softer = std::isfinite(under)
                                 ? fmt::format("by about {:.1f} % where the whole ball presses",
                                               100.0 * under / (under + p.tool.stiffness))
                                 : "most where the ball reaches what is held";
  lines.push_back(fmt::format(
      "objects.{}: {} vertices of which {} can be touched, {:.0f} MB, at most {:.0f} MB while it "
      "is prepared; at most {:.0f} N/m; the spring of the hand makes it softer than its "
      "elements, {}; stays calm with {:.2g} N·s/m of damping, and the hand of [hand] has {:g}",
      field.name, p.mesh->tets.vertices.size(), p.body->touched(), 1e-6 * memory.kept,
      1e-6 * memory.most, 1.0 / (1.0 / most + 1.0 / p.tool.stiffness), softer, needed, damping));
  const deformable::TouchCost cost = deformable::measured_cost(p.body, p.tool);
  lines.push_back(words_of_cost(field.name, cost, rate));
  if (cost.crowded) {
    lines.push_back(fmt::format(
        "objects.{}: pressed 0.4 of its radius deep the ball lies on more places than are "
        "computed and may be felt softer than the elements; use fewer cells or a smaller ball",
        field.name));
  }
}

constexpr const char* kCheaper =
    "use fewer cells, or of springs smaller constants or more density, which need fewer or shorter "
    "steps";

/// Words about a body that moves at its own rate.
/// @param cost  springs: of a tick at the loop's rate; elements: of a step
void add_words_of_own_rate(const scene::Field& field, const scene::DeformableObjectParameters& p,
                           double rate, const deformable::TouchCost& cost,
                           std::vector<std::string>& lines) {
  const double window = p.rates.window / rate;
  const double busy_rate = p.implicit ? p.rate : rate;
  lines.push_back(fmt::format(
      "objects.{}: moves {:g} times a second, {} ticks at once, and is felt {:g} to {:g} ms later "
      "through its surface's compliance of then; that keeps a thread of its own busy for {:.0f} % "
      "(measured now, on this machine)",
      field.name, p.rate, p.rates.window, 1e3 * window, 1e3 * (2.0 * window - 1.0 / rate),
      100.0 * cost.median * busy_rate));
  if (cost.most * busy_rate > 1.0) {
    lines.push_back(fmt::format(
        "objects.{}: that is more than there is: the body would be late and move too slowly; {}",
        field.name, kCheaper));
  }
}

/// How a body that moves is stepped.
std::string words_of_steps(const scene::Field& field, const scene::DeformableObjectParameters& p,
                           double rate) {
  const deformable::MovingBody& body = *p.moving;
  const std::size_t tetrahedra = p.mesh->tets.tetrahedra.size();
  if (body.implicit) {
    return fmt::format("objects.{}: {} tetrahedra of elements, one implicit step of {:g} ms",
                       field.name, tetrahedra, 1e3 * body.implicit->options().step);
  }
  const int steps = deformable::steps_on_a_tick(body, 1.0 / rate);
  return fmt::format(
      "objects.{}: {} tetrahedra of springs, {} step{} of {:.3g} ms on a tick (the longest that is "
      "stable at rest: {:.3g} ms)",
      field.name, tetrahedra, steps, steps == 1 ? "" : "s", 1e3 / (rate * steps),
      1e3 * body.stable_step);
}

/// Words about a body that moves.
void add_words_of_motion(const scene::Field& field, const scene::DeformableObjectParameters& p,
                         double rate, double damping, std::vector<std::string>& lines) {
  lines.push_back(fmt::format(
      "{}; gives no energy to a hand of at least {:g} N·s/m of damping, and the hand of [hand] has "
      "{:g}",
      words_of_steps(field, p, rate), deformable::EnergyAccount::kDamping, damping));
  const double period = p.implicit ? p.rates.window / rate : 1.0 / rate;
  deformable::MovingTouch touch(p.moving, p.tool, period);
  const deformable::TouchCost cost =
      deformable::measured_cost(touch, *p.mesh, p.tool.radius, period);
  if (p.gives) {
    add_words_of_own_rate(field, p, rate, cost, lines);
    return;
  }
  lines.push_back(words_of_cost(field.name, cost, rate));
  if (cost.most * rate > 1.0) {
    lines.push_back(fmt::format(
        "objects.{}: that does not fit into a tick: this machine holds {:.0f} ticks a second; {}, "
        "or give the body a `rate` of its own",
        field.name, 1.0 / cost.most, kCheaper));
  }
}

}  // namespace

void prepare_moving_bodies(std::vector<scene::Field>& fields, double rate) {
  for (scene::Field& field : fields) {
    auto* p = std::get_if<scene::DeformableObjectParameters>(&field.kind);
    if (p == nullptr || !p->mesh || !p->moves()) {
      continue;
    }
    if (p->springs) {
      p->moving = deformable::prepared(p->mesh, *p->springs);
      deformable::steps_on_a_tick(*p->moving, 1.0 / rate);
    }
    p->rates.window = p->rate > 0.0 ? deformable::ticks_of_window(*p->mesh, rate, p->rate) : 1;
    if (p->implicit) {
      p->moving = deformable::prepared(p->mesh, *p->implicit, p->rates.window / rate);
    }
    p->shape = std::make_shared<deformable::MovingShape>(p->mesh->tets.vertices.size());
  }
}

void check_bodies(const std::vector<scene::Field>& fields) {
  for (const scene::Field& field : fields) {
    const auto* p = std::get_if<scene::DeformableObjectParameters>(&field.kind);
    if (p != nullptr && p->mesh && !p->moves()) {
      deformable::check_tissue(*p->mesh, p->tissue);
      deformable::check_memory(*p->mesh);
    }
  }
}

void prepare_bodies(std::vector<scene::Field>& fields, double rate, bool real) {
  prepare_moving_bodies(fields, rate);
  for (scene::Field& field : fields) {
    auto* p = std::get_if<scene::DeformableObjectParameters>(&field.kind);
    if (p != nullptr && p->mesh && !p->moves()) {
      p->body = deformable::prepared(p->mesh, p->tissue);
    } else if (p != nullptr && p->moving && p->rate > 0.0) {
      p->gives = deformable::prepared_compliance(p->moving, 1.0 / p->rate);
      p->rates.threaded = real;
    }
  }
}

std::vector<std::string> words_of_bodies(const std::vector<scene::Field>& fields, double rate,
                                         double damping) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto* p = std::get_if<scene::DeformableObjectParameters>(&fields[i].kind);
    if (p == nullptr || !p->prepared()) {
      continue;
    }
    if (p->moving) {
      add_words_of_motion(fields[i], *p, rate, damping, lines);
    } else {
      add_words_of_elements(fields[i], *p, scene::stiffness_bound(fields, i), rate, damping, lines);
    }
    if (p->tool.radius < deformable::smallest_ball(*p->mesh)) {
      lines.push_back(fmt::format(
          "objects.{}: a ball of {:g} m is smaller than half a cell and is felt as one of {:.3g} m",
          fields[i].name, p->tool.radius, deformable::smallest_ball(*p->mesh)));
    }
  }
  return lines;
}

}  // namespace haptrial::protocols
