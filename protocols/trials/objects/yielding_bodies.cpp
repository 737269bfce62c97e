#include "protocols/trials/objects/yielding_bodies.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "core/deformable/touch/prepared.h"
#include "core/deformable/touch/touch_cost.h"
#include "core/scene/needed_damping.h"

namespace haptrial::protocols {

void prepare_bodies(std::vector<scene::Field>& fields) {
  for (scene::Field& field : fields) {
    auto* p = std::get_if<scene::YieldingParameters>(&field.kind);
    if (p != nullptr && p->mesh) {
      p->body = deformable::prepared(p->mesh, p->tissue);
    }
  }
}

std::vector<std::string> words_of_bodies(const std::vector<scene::Field>& fields, double rate,
                                         double damping) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto* p = std::get_if<scene::YieldingParameters>(&fields[i].kind);
    if (p == nullptr || !p->body) {
      continue;
    }
    const scene::Steepness steepness = scene::steepness(fields, i);
    const double needed = scene::needed_damping_below(0.0, steepness, rate);
    const double most = deformable::stiffest_touch(*p->body, p->tool.radius);
    const double under = p->body->stiffest(p->tool.radius);
    const deformable::ComplianceMemory memory = deformable::compliance_memory(*p->mesh);
    // Infinite where the ball reaches what is held.
    const std::string softer = std::isfinite(under)
                                   ? fmt::format("by about {:.1f} % where the whole ball presses",
                                                 100.0 * under / (under + p->tool.stiffness))
                                   : "most where the ball reaches what is held";
    lines.push_back(fmt::format(
        "objects.{}: {} vertices of which {} can be touched, {:.0f} MB, at most {:.0f} MB while it "
        "is prepared; at most {:.0f} N/m; the spring of the hand makes it softer than its "
        "elements, {}; stays calm with {:.2g} N·s/m of damping, and the hand of [hand] has {:g}",
        fields[i].name, p->mesh->tets.vertices.size(), p->body->touched(), 1e-6 * memory.kept,
        1e-6 * memory.most, 1.0 / (1.0 / most + 1.0 / p->tool.stiffness), softer, needed, damping));
    const deformable::TouchCost cost = deformable::measured_cost(p->body, p->tool);
    constexpr double kMicroseconds = 1e6;
    lines.push_back(fmt::format(
        "objects.{}: a tick in contact takes {:.0f} µs in the median and less than {:.0f} µs in 99 "
        "of 100 (measured now, on this machine), of {:.0f} µs at {:g} Hz",
        fields[i].name, kMicroseconds * cost.median, kMicroseconds * cost.most,
        kMicroseconds / rate, rate));
    if (cost.crowded) {
      lines.push_back(fmt::format(
          "objects.{}: pressed 0.4 of its radius deep the ball lies on more places than are "
          "computed and may be felt softer than the elements; use fewer cells or a smaller ball",
          fields[i].name));
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
