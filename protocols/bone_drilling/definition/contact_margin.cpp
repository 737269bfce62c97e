#include "protocols/bone_drilling/definition/contact_margin.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/bone/simulator/saw.h"
#include "protocols/bone_drilling/definition/bone_definition.h"

namespace haptrial::protocols {
namespace {

/// The value at which an increasing function reaches `wanted`; `high` if it does not.
template <class Function>
double inverse(const Function& function, double high, double wanted) {
  double low = 0.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (function(middle) < wanted ? low : high) = middle;
  }
  return high;
}

/// d m(V) / dh at a force. @param volume, section  of what is immersed by h [m^3], [m^2]
template <class Volume, class Section>
double stiffness_at(const Volume& volume, const Section& section, double deepest, double force,
                    const bone::FeelParameters& limits) {
  const double reached = std::min(force, limits.force_limit);
  bone::FeelParameters feel = limits;
  feel.force_limit = 2.0 * reached;  // its own limit is flat
  const double depth =
      inverse([&](double h) { return bone::magnitude(volume(h), feel); }, deepest, reached);
  const double gain = volume(depth) > feel.threshold ? feel.second_gain : feel.first_gain;
  return gain * section(depth);
}

/// The sum over the sections of a burr, across its axis, from the tip up.
template <class OfSection>
double along(const bone::BurrShape& shape, double high, const OfSection& of) {
  constexpr int kSlices = 200;
  const double slice = high / kSlices;
  double sum = 0.0;
  for (int n = 0; n < kSlices; ++n) {
    sum += slice * of(shape.radius_at((n + 0.5) * slice - shape.half_length()));
  }
  return sum;
}

/// The greater one of a burr that stands on its tip and one that lies on its side.
double stiffness_of_shape(const bone::BurrShape& shape, double force,
                          const bone::FeelParameters& feel) {
  constexpr double kPi = std::numbers::pi;
  const double upright = stiffness_at(
      [&](double h) { return along(shape, h, [](double r) { return kPi * r * r; }); },
      [&](double h) { return kPi * std::pow(shape.radius_at(h - shape.half_length()), 2); },
      shape.half_length(), force, feel);
  const double wide = 0.5 * shape.dimensions().diameter;
  const double length = 2.0 * shape.half_length();
  const auto chord = [wide](double r, double h) {  // half of it
    const double below = wide - h;                 // the axis, to the plane
    return std::sqrt(std::max(0.0, r * r - below * below));
  };
  const double lying = stiffness_at(
      [&](double h) {
        return along(shape, length, [&](double r) {
          const double half = chord(r, h);
          return half > 0.0 ? r * r * std::atan2(half, wide - h) - (wide - h) * half : 0.0;
        });
      },
      [&](double h) { return along(shape, length, [&](double r) { return 2.0 * chord(r, h); }); },
      wide, force, feel);
  return std::max(upright, lying);
}

}  // namespace

double flat_bone_stiffness(const bone::BurrTool& tool, double force) {
  const bone::BurrShape shape(tool.burr.dimensions());
  if (bone::is_saw(tool)) {  // the teeth or the sheet lie on bone by their largest sides
    const bone::BurrParameters& teeth = tool.burr;
    return std::max(tool.feel.second_gain * teeth.diameter * teeth.length,
                    tool.shaft->feel.second_gain * teeth.diameter * tool.shaft->length);
  }
  if (!shape.is_ball()) {
    return stiffness_of_shape(shape, force, tool.feel);
  }
  const double r = tool.radius();
  return stiffness_at([r](double h) { return std::numbers::pi * h * h * (r - h / 3.0); },
                      [r](double h) { return std::numbers::pi * h * (2.0 * r - h); }, r, force,
                      tool.feel);
}

double stable_stiffness(const control::HandleLoop& loop, const control::HeldBy& hand) {
  constexpr double kStable = 1.0 + 1e-9;
  constexpr double kStiffest = 1e6;  // [N/m]
  return inverse(
      [&](double stiffness) {
        return control::spectral_radius({stiffness, 0.0}, loop, hand) > kStable ? 1.0 : 0.0;
      },
      kStiffest, 0.5);
}

std::optional<ContactMargin> contact_margin(const BoneDefinition& d) {
  std::optional<ContactMargin> worst;
  for (const bone::ToolSpec& tool : d.simulator.tools) {
    const auto* burr = tool.as<bone::BurrTool>();
    if (burr == nullptr) {
      continue;
    }
    const double stiffness = flat_bone_stiffness(*burr, d.drilling.force_limit) / d.drilling.scale;
    if (!worst || stiffness > worst->stiffness) {
      worst = {tool.name, d.drilling.force_limit, stiffness, 0.0};
    }
  }
  if (worst) {
    control::HandleLoop loop;
    loop.handle_mass = d.hand.handle_mass;
    loop.rate = d.rate;
    loop.force_delay = d.device.force_delay;
    worst->stable = stable_stiffness(loop, {d.hand.hand_mass, d.hand.damping, d.hand.stiffness});
  }
  return worst;
}

std::string describe(const ContactMargin& m) {
  return fmt::format(
      "contact: flat bone under the burr {} is {:.1f} N/mm stiff to the hand at {:g} N; without "
      "friction the loop carries {:.1f} N/mm with the definition's hand",
      m.tool, 1e-3 * m.stiffness, m.force, 1e-3 * m.stable);
}

}  // namespace haptrial::protocols
