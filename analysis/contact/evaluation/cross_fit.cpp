#include "analysis/contact/evaluation/cross_fit.h"

namespace haptrial::evaluation {

std::optional<double> CrossFit::kept(std::size_t fitted, std::size_t tested) const {
  constexpr double kNoGain = 1e-3;  // of the error without friction
  const FrictionFit& best = own[tested];
  const double gain = best.without - best.with;
  if (!(gain > kNoGain * best.without)) {
    return std::nullopt;
  }
  return (best.without - error[fitted][tested]) / gain;
}

CrossFit cross_fit(std::span<const FeltContact> contacts, contact::RendererKind kind,
                   const contact::RendererOptions& options) {
  CrossFit result;
  for (const FeltContact& c : contacts) {
    result.own.push_back(fit_friction(*c.contact, *c.body, kind, options));
  }
  for (std::size_t fitted = 0; fitted < contacts.size(); ++fitted) {
    contact::RendererOptions with = options;
    with.friction = {result.own[fitted].friction, result.own[fitted].friction};
    std::vector<double>& row = result.error.emplace_back();
    for (const FeltContact& tested : contacts) {
      const RenderedContact r = render_contact(*tested.contact, *tested.body, kind, with);
      row.push_back(force_error(tested.contact->force, r.force).root_mean_square);
    }
  }
  return result;
}

}  // namespace haptrial::evaluation
