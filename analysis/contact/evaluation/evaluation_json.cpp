#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/contact/evaluation/evaluation_report.h"
#include "core/contact/renderer_kinds.h"

namespace haptrial::evaluation {
namespace {

using Json = nlohmann::ordered_json;

/// JSON has no infinity: null says that there is no bound.
Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

Json to_json(const Interval& i) {
  return {{"value", number(i.value)}, {"low_95", number(i.low)}, {"high_95", number(i.high)}};
}

Json to_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Json contact_json(const PreparedContact& c) {
  Json json{{"samples", c.time.size()},         {"rate_Hz", c.rate},
            {"stiffness_N_per_m", c.stiffness}, {"contact_share", c.contact_share},
            {"lag_used_s", c.lag_used},         {"velocity_noise_m_per_s", c.velocity_noise}};
  if (c.lag) {
    json["lag"] = {{"lag_s", c.lag->lag},
                   {"low_95", c.lag->low},
                   {"high_95", c.lag->high},
                   {"explained", c.lag->explained},
                   {"doubt", c.lag->doubt}};
  }
  if (c.load) {
    json["sensor_load"] = {{"weight_N", to_json(c.load->load.weight)},
                           {"force_offset_N", to_json(c.load->load.force_offset)},
                           {"force_rms_N", c.load->force_rms}};
  }
  if (c.registration) {
    const Registration& r = *c.registration;
    Json matrix = Json::array();
    for (int row = 0; row < 3; ++row) {
      const auto& m = r.body_from_world.matrix();
      matrix.push_back({m(row, 0), m(row, 1), m(row, 2), m(row, 3)});
    }
    json["registration"] = {{"body_from_world", matrix}, {"rms_m", r.rms},
                            {"median_m", r.median},      {"p95_m", r.p95},
                            {"worst_m", r.worst},        {"unfixed", r.unfixed}};
  }
  return json;
}

Json operations_json(const RenderedContact& r) {
  const double ticks = std::max(1.0, static_cast<double>(r.operations.ticks));
  Json json{{"ticks", r.operations.ticks}};
  for (const contact::OperationCount& c : contact::kOperationCounts) {
    json[std::string(c.name)] = {{"mean", static_cast<double>(r.operations.*c.count) / ticks},
                                 {"most", r.most.*c.count}};
  }
  return json;
}

Json to_json(const ForceError& force, const BandError& bands) {
  return {{"root_mean_square_N", force.root_mean_square},
          {"mean_norm_N", force.mean_norm},
          {"worst_N", force.worst},
          {"mean_force_N", force.mean_force},
          {"below_10_Hz_N", bands.slow},
          {"10_to_100_Hz_N", bands.middle},
          {"above_100_Hz_N", bands.fast}};
}

Json to_json(const NoticeableError& noticeable) {
  return {{"median_thresholds", noticeable.median},
          {"beyond_7_percent", noticeable.beyond_low},
          {"beyond_10_percent", noticeable.beyond_high},
          {"samples", noticeable.samples},
          {"verdict", noticeable.verdict}};
}

Json to_json(const OtherRendering& other) {
  return {{"name", other.name},
          {"force_error", to_json(other.force, other.bands)},
          {"noticeable", to_json(other.noticeable)}};
}

Json to_json(const EvaluatedRendering& r, const PreparedContact& c) {
  Json places = Json::array();
  for (const ProblemPlace& place : r.position.places) {
    places.push_back(
        {{"from_s", c.time[place.first]}, {"to_s", c.time[place.last]}, {"worst_m", place.worst}});
  }
  return {
      {"renderer", contact::name_of(r.kind)},
      {"friction", r.friction},
      {"radius_m", r.radius},
      {"force_error", to_json(r.force, r.bands)},
      {"position_error",
       {{"root_mean_square_m", r.position.root_mean_square},
        {"mean_norm_m", r.position.mean_norm},
        {"worst_m", r.position.worst},
        {"beyond_share", r.position.beyond_share},
        {"places", places}}},
      {"noticeable", to_json(r.noticeable)},
      {"tick_s", {{"median", r.ticks.median}, {"p999", r.ticks.p999}, {"worst", r.ticks.worst}}},
      {"operations_per_tick", operations_json(r.rendered)},
      {"preparation_s", r.rendered.preparation},
      {"memory_bytes", r.rendered.memory},
      {"unsettled_ticks", r.rendered.unsettled}};
}

Json to_json(const IdentifiedContact& found) {
  Json json{{"contact_samples", found.contact_samples},
            {"slip_samples", found.slip_samples},
            {"stick_phases", found.stick_phases},
            {"compliance_m_per_N", to_json(found.compliance)},
            {"stiffness_N_per_m", to_json(found.stiffness)}};
  const auto add = [&](const char* name, const std::optional<Interval>& i) {
    json[name] = i ? to_json(*i) : Json(nullptr);
  };
  add("dynamic_friction", found.dynamic_friction);
  add("static_friction", found.static_friction);
  add("texture_amplitude_m", found.texture);
  json["confounded"] = found.confounded;
  return json;
}

Json to_json(const NamedCrossFit& cross) {
  Json json{{"recordings", cross.names}, {"root_mean_square_N", cross.fit.error}};
  for (std::size_t i = 0; i < cross.names.size(); ++i) {
    const FrictionFit& own = cross.fit.own[i];
    json["friction"].push_back(own.friction);
    json["root_mean_square_without_N"].push_back(own.without);
    Json& kept = json["kept"].emplace_back(Json::array());
    for (std::size_t tested = 0; tested < cross.names.size(); ++tested) {
      const std::optional<double> share = cross.fit.kept(i, tested);
      kept.push_back(share ? Json(*share) : Json(nullptr));
    }
  }
  return json;
}

}  // namespace

std::string evaluation_json(const Evaluation& e, const EvaluationNames& names) {
  Json root{{"recording", names.recording},
            {"mesh", names.mesh},
            {"simulated", names.simulated},
            {"triangles", e.triangles},
            {"contact", contact_json(e.contact)}};
  root["best_friction"] = e.friction ? Json{{"friction", e.friction->friction},
                                            {"root_mean_square_without_N", e.friction->without},
                                            {"root_mean_square_with_N", e.friction->with}}
                                     : Json(nullptr);
  root["renderings"] = Json::array();
  for (const EvaluatedRendering& r : e.renderings) {
    root["renderings"].push_back(to_json(r, e.contact));
  }
  root["other_programs"] = Json::array();
  for (const OtherRendering& other : e.others) {
    root["other_programs"].push_back(to_json(other));
  }
  root["identified"] = e.identified ? to_json(*e.identified) : Json(nullptr);
  root["cross_fit"] = e.cross ? to_json(*e.cross) : Json(nullptr);
  root["remarks"] = e.remarks;
  return root.dump(2) + "\n";
}

}  // namespace haptrial::evaluation
