#pragma once

#include <optional>
#include <string>

#include "core/bone/simulator/simulator_tools.h"
#include "core/control/handle_loop.h"

namespace haptrial::protocols {

struct BoneDefinition;

/// How stiff flat bone is under a burr, and how stiff it may be under the definition's hand.
struct ContactMargin {
  std::string tool;
  double force{0.0};      // the limit of the force, at which bone is stiffest [N]
  double stiffness{0.0};  // of flat bone there, for the hand, which drilling.scale moves [N/m]
  double stable{0.0};     // up to which the sampled loop is stable [N/m]
};

/// Stiffness of flat bone under a force, d m(V) / dh, with V = pi h^2 (r - h / 3) of a sphere of
/// radius r that is immersed by h; at most that of a burr immersed by its radius. Of another shape
/// the greater one of its tip upright and its side [N/m]. @param force  > 0 [N]
double flat_bone_stiffness(const bone::BurrTool& burr, double force);

/// Up to which an undamped spring is stable in the sampled loop, with a hand on it [N/m]. The law
/// is that of guidance (control/handle_loop.h) without damping in software, since bone has none.
double stable_stiffness(const control::HandleLoop& loop, const control::HeldBy& hand);

/// Margin for the burr under which bone is stiffest, with the definition's hand and virtual device;
/// nothing without a burr.
std::optional<ContactMargin> contact_margin(const BoneDefinition& definition);

/// A sentence without a verdict: friction, which the law leaves out, holds a burr at rest beyond
/// it.
std::string describe(const ContactMargin& margin);

}  // namespace haptrial::protocols
