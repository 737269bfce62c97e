#include "protocols/bone_drilling/definition/contact_margin.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

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

}  // namespace

double flat_bone_stiffness(const bone::BurrTool& tool, double force) {
  const double r = tool.radius();
  const auto volume = [r](double depth) {
    return std::numbers::pi * depth * depth * (r - depth / 3.0);
  };
  const double reached = std::min(force, tool.feel.force_limit);
  const double depth = inverse(
      [&](double h) {
        bone::FeelParameters feel = tool.feel;
        feel.force_limit = 2.0 * reached;  // its own limit is flat
        return bone::magnitude(volume(h), feel);
      },
      r, reached);
  const double gain =
      volume(depth) > tool.feel.threshold ? tool.feel.second_gain : tool.feel.first_gain;
  return gain * std::numbers::pi * depth * (2.0 * r - depth);
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
    const double stiffness = flat_bone_stiffness(*burr, d.drilling.force_limit);
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
      "contact: flat bone under the burr {} is {:.1f} N/mm stiff at {:g} N; without friction the "
      "loop carries {:.1f} N/mm with the definition's hand",
      m.tool, 1e-3 * m.stiffness, m.force, 1e-3 * m.stable);
}

}  // namespace haptrial::protocols
