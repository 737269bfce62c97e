// The file of a score, and its section of a page.

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "analysis/bone_drilling/feedback/page_frame.h"
#include "analysis/bone_drilling/feedback/procedure_tables.h"
#include "analysis/bone_drilling/feedback/score.h"
#include "analysis/document/html.h"
#include "core/base/counted.h"
#include "core/base/error.h"
#include "core/base/file_text.h"

namespace haptrial::analysis::drilling {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kKind = "haptrial score of drillings";

ScoreMetric metric_of(const Json& root) {
  return {root.at("name"),  root.at("title"), root.at("unit"), root.at("mean"),
          root.at("scale"), root.at("slope"), root.at("low"),  root.at("high")};
}

ScoreModel model_of(const Json& root) {
  ScoreModel model;
  model.study = root.at("study");
  model.participants = root.at("participants");
  model.procedures = root.at("procedures");
  model.raters = root.at("raters");
  model.simulated = root.at("simulated");
  model.version = root.at("metrics_version");
  model.intercept = root.at("mean_rating");
  model.half_width = root.at("half_width_95");
  model.r = root.at("r_left_out");
  for (const Json& metric : root.at("metrics")) {
    model.metrics.push_back(metric_of(metric));
  }
  model.bones = root.at("bones").get<std::vector<std::string>>();
  model.rules = root.at("rules").get<std::map<std::string, std::string>>();
  return model;
}

std::string parts_table(const Score& score) {
  std::vector<std::vector<std::string>> rows;
  for (const ScorePart& part : score.parts) {
    rows.push_back({part.title, part.unit, number_text(part.value),
                    fmt::format("{:+.2f}", part.points), part.outside ? "outside" : ""});
  }
  return html_table({"metric", "unit", "value", "points", "values of the study"}, rows);
}

std::string lowered(const Score& score) {
  constexpr double kWorthSaying = 0.05;  // [points]
  std::string list;
  for (std::size_t n = 0; n < score.parts.size() && n < 3; ++n) {
    if (score.parts[n].points < -kWorthSaying) {
      list += fmt::format("{}{} ({:+.2f})", list.empty() ? "" : ", ", score.parts[n].title,
                          score.parts[n].points);
    }
  }
  return list.empty() ? "Nothing lowered it by more than 0.05 points."
                      : "Lowered most by: " + list + ".";
}

}  // namespace

std::string score_model_text(const ScoreModel& model) {
  Json root{{"kind", kKind},
            {"study", model.study},
            {"participants", model.participants},
            {"procedures", model.procedures},
            {"raters", model.raters},
            {"simulated", model.simulated},
            {"metrics_version", model.version},
            {"mean_rating", model.intercept},
            {"half_width_95", model.half_width},
            {"r_left_out", model.r},
            {"metrics", Json::array()},
            {"bones", model.bones},
            {"rules", model.rules}};
  for (const ScoreMetric& m : model.metrics) {
    root["metrics"].push_back({{"name", m.name},
                               {"title", m.title},
                               {"unit", m.unit},
                               {"mean", m.mean},
                               {"scale", m.scale},
                               {"slope", m.slope},
                               {"low", m.low},
                               {"high", m.high}});
  }
  return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

ScoreModel read_score_model(const std::filesystem::path& file) {
  try {
    const Json root = Json::parse(file_text(file));
    if (root.value("kind", "") == kKind) {
      return model_of(root);
    }
  } catch (const Json::exception&) {  // said below
  }
  throw InputError(
      fmt::format("{}: is not the file of a score; allowed: one that haptrial bone score wrote",
                  file.string()));
}

std::string score_section(const ScoreModel& model, const Defined<Score>& score) {
  std::string html = heading("Score");
  if (!score) {
    return html +
           paragraph(fmt::format("There is no score by {}: {}.", model.study, score.because()));
  }
  html += "<p id=\"score\">" +
          escape_html(fmt::format("{:.1f} points of 5, 95 % interval {:.1f} to {:.1f}. {}",
                                  score->value, score->low, score->high, lowered(*score))) +
          "</p>\n";
  html += paragraph(fmt::format(
      "It predicts the mean rating that {} would give to this procedure, from {} of {} in {}; for "
      "participants left out, prediction and rating correlate with R = {:.2f}. The interval is "
      "that of one procedure.{}",
      counted(model.raters, "rater", "raters"),
      counted(model.procedures, "procedure", "procedures"),
      counted(model.participants, "participant", "participants"), model.study, model.r,
      model.simulated ? " Participants or raters were programs: it says nothing about surgeons."
                      : ""));
  return html + parts_table(*score) +
         paragraph(fmt::format(
             "Points are what each metric adds to the study's mean of {:.2f}. Metrics that go "
             "together share their points. Outside of the study's values the score is a guess.",
             model.intercept));
}

}  // namespace haptrial::analysis::drilling
