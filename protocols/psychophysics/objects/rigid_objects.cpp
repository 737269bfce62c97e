#include "protocols/psychophysics/objects/rigid_objects.h"

#include <fmt/format.h>

#include "core/contact/renderer_kinds.h"
#include "core/scene/needed_damping.h"

namespace haptrial::protocols {
namespace {

/// Why of a solid nothing is proven.
std::string doubt(const scene::RigidObjectParameters& p) {
  return contact::kind_of(p.renderer).passive
             ? "shading turns its force away from its spring"
             : fmt::format("its renderer is \"{}\"", contact::name_of(p.renderer));
}

}  // namespace

std::vector<std::string> words_of_rigid_objects(const std::vector<scene::Field>& fields,
                                                double rate, double damping) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto* p = std::get_if<scene::RigidObjectParameters>(&fields[i].kind);
    if (p == nullptr) {
      continue;
    }
    const scene::StiffnessBound bound = scene::stiffness_bound(fields, i);
    const double needed = 0.5 * bound.stiffness / rate;
    lines.push_back(fmt::format(
        "objects.{}: at most {:.4g} N/m; {} {:.3g} N·s/m of damping at {:g} Hz (K T / 2){}; it "
        "has {:g} itself, and the hand of [hand] has {:g}",
        fields[i].name, bound.stiffness,
        bound.passive ? "passive with more than" : "its spring alone needs", needed, rate,
        bound.passive ? "" : ", and nothing is proven of it, since " + doubt(*p), p->gains.damping,
        damping));
    if (p->body && p->body->closed && !p->body->outwards) {
      lines.push_back(fmt::format(
          "objects.{}: its faces look inwards, so that it is a room, free inside and solid around; "
          "haptrial mesh repair turns them",
          fields[i].name));
    }
  }
  return lines;
}

}  // namespace haptrial::protocols
