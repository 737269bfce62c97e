#include "analysis/contact/evaluation/evaluate_rendering.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "analysis/contact/evaluation/check_body.h"
#include "core/contact/renderer_kinds.h"

namespace haptrial::evaluation {
namespace {

using contact::RendererKind;

constexpr double kSmallSphere = 0.01;  // of the body's size, where the probe has no radius

bool has_friction(RendererKind kind) { return contact::kind_of(kind).friction; }

contact::RendererOptions options_for(RendererKind renderer, const contact::FeltBody& body,
                                     const EvaluationOptions& o) {
  using Tool = contact::KindOfRenderer::Tool;
  const contact::KindOfRenderer& kind = contact::kind_of(renderer);
  contact::RendererOptions options;
  options.resolution = o.resolution;
  if (kind.friction) {
    options.crease_angle = o.crease_angle;
  }
  if (kind.tool != Tool::kPoint) {
    options.radius = o.prepare.radius;
  }
  if (kind.tool == Tool::kBall && options.radius == 0.0) {
    options.radius = kSmallSphere * body.size;
  }
  return options;
}

void identify(const EvaluationOptions& o, Evaluation& result) {
  IdentificationOptions options;
  options.stick.least_force = o.prepare.least_force;
  options.velocity_noise = result.contact.velocity_noise;
  options.friction_by_lag = result.contact.friction_by_lag;
  options.lag_like_friction = result.contact.lag_like_friction;
  options.texture = o.texture;
  try {
    result.identified = identify_contact(result.contact.samples, options);
  } catch (const std::invalid_argument& error) {
    result.remarks.push_back(fmt::format("Nothing is identified: {}.", error.what()));
  }
}

/// Contacts that a renderer does not feel are no small matter beside its errors.
void remark_on_lost(const Evaluation& e, const EvaluatedRendering& r,
                    std::vector<std::string>& remarks) {
  constexpr double kFew = 0.01;
  const double share = static_cast<double>(r.rendered.lost) /
                       (e.contact.contact_share * static_cast<double>(e.contact.touching.size()));
  if (share > kFew) {
    remarks.push_back(
        fmt::format("{} with friction {:.3f} feels nothing on {:.0f} % of the samples in contact.",
                    contact::name_of(r.kind), r.friction, 100.0 * share));
  }
}

void remark(Evaluation& result) {
  for (const EvaluatedRendering& r : result.renderings) {
    remark_on_lost(result, r, result.remarks);
    if (r.rendered.unsettled > 0) {
      result.remarks.push_back(fmt::format(
          "{} of {} ticks of {} with friction {:.3f} ended before its proxy was at rest.",
          r.rendered.unsettled, r.rendered.force.size(), contact::name_of(r.kind), r.friction));
    }
  }
  result.remarks.push_back(
      "Times are those of this computer; operations are the same on every one.");
}

PreparedContact prepare_named(const NamedRecording& given, const contact::FeltBody& body) {
  try {
    return prepare_contact(given.recording, body, given.prepare);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}: {}", given.name, error.what()));
  }
}

}  // namespace

EvaluatedRendering measured_rendering(const PreparedContact& contact, const contact::FeltBody& body,
                                      RendererKind kind, const contact::RendererOptions& options,
                                      double threshold) {
  EvaluatedRendering r{kind,
                       options.friction.dynamic_friction,
                       options.radius,
                       render_contact(contact, body, kind, options),
                       {},
                       {},
                       {},
                       {},
                       {}};
  r.force = force_error(contact.force, r.rendered.force);
  r.bands = band_error(contact.force, r.rendered.force, contact.rate);
  r.position = position_error(contact.out, r.rendered.place, threshold);
  r.noticeable = noticeable_error(contact.force, r.rendered.force);
  r.ticks = tick_times(r.rendered.tick_seconds);
  return r;
}

OtherRendering measured_forces(const PreparedContact& contact, const std::string& name,
                               std::vector<Eigen::Vector3d> forces) {
  if (forces.size() != contact.force.size()) {
    throw std::invalid_argument(
        fmt::format("{} has {} forces; allowed: {}, one for each tick of the in-trajectory", name,
                    forces.size(), contact.force.size()));
  }
  OtherRendering other{name, std::move(forces), {}, {}, {}};
  other.force = force_error(contact.force, other.rendered);
  other.bands = band_error(contact.force, other.rendered, contact.rate);
  other.noticeable = noticeable_error(contact.force, other.rendered);
  return other;
}

Evaluation evaluate_rendering(const ContactRecording& recording, const contact::FeltBody& body,
                              const EvaluationOptions& options) {
  if (options.renderers.empty()) {
    throw std::invalid_argument("an evaluation needs a renderer");
  }
  Evaluation result;
  result.contact = prepare_contact(recording, body, options.prepare);
  result.triangles = body.mesh.triangles.size();
  result.remarks = result.contact.remarks;
  const std::vector<std::string> of_body = body_remarks(body);
  result.remarks.insert(result.remarks.end(), of_body.begin(), of_body.end());
  const auto measure = [&](RendererKind kind, const contact::RendererOptions& o) {
    result.renderings.push_back(
        measured_rendering(result.contact, body, kind, o, options.threshold));
  };
  for (const RendererKind kind : options.renderers) {
    measure(kind, options_for(kind, body, options));
  }
  double friction = options.friction.value_or(0.0);
  for (const RendererKind kind : options.renderers) {
    if (!has_friction(kind)) {
      continue;
    }
    contact::RendererOptions with = options_for(kind, body, options);
    if (!options.friction && !result.friction) {
      result.friction = fit_friction(result.contact, body, kind, with);
      friction = result.friction->friction;
    }
    if (friction > 0.0) {
      with.friction = {friction, friction};
      measure(kind, with);
    }
  }
  identify(options, result);
  remark(result);
  return result;
}

void add_cross_fit(Evaluation& evaluation, const std::string& name,
                   const std::vector<NamedRecording>& others, const contact::FeltBody& body,
                   const EvaluationOptions& options) {
  const auto kind = std::find_if(options.renderers.begin(), options.renderers.end(), has_friction);
  if (kind == options.renderers.end()) {
    throw std::invalid_argument("a test on other recordings needs a renderer with friction");
  }
  NamedCrossFit cross{{name}, {}};
  std::vector<PreparedContact> prepared;
  prepared.reserve(others.size());
  std::vector<FeltContact> contacts{{&evaluation.contact, &body}};
  for (const NamedRecording& other : others) {
    cross.names.push_back(other.name);
    prepared.push_back(prepare_named(other, body));
    for (const std::string& remark : prepared.back().remarks) {
      evaluation.remarks.push_back(fmt::format("{}: {}", other.name, remark));
    }
    contacts.push_back({&prepared.back(), &body});
  }
  cross.fit = cross_fit(contacts, *kind, options_for(*kind, body, options));
  evaluation.cross = std::move(cross);
}

}  // namespace haptrial::evaluation
