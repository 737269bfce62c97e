#include "experiments/preview/preview.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <future>
#include <utility>

#include "analysis/document/palette.h"
#include "experiments/preview/film.h"
#include "experiments/preview/preview_pictures.h"
#include "experiments/preview/virtual_trial.h"
#include "experiments/study/study_run.h"

namespace haptrial::experiments {
namespace {

namespace palette = analysis::palette;

/// Longer trials, those of drillings, are simulated for a page in their first seconds alone.
constexpr double kLongestTrial = 50.0;  // [s]
constexpr double kFirstSeconds = 10.0;  // [s]

constexpr std::array<analysis::Look, 3> kLooks{{{palette::kBlue, palette::kSolid, 7, 2.5, 1.0},
                                                {palette::kOrange, palette::kLong, 7, 2.5, 1.0},
                                                {palette::kGreen, palette::kMixed, 7, 2.5, 1.0}}};

/// So many samples draw a curve as well as all of them.
std::size_t every_so_many(std::size_t samples) {
  constexpr std::size_t kDrawn = 1500;
  return std::max<std::size_t>(1, samples / kDrawn);
}

analysis::Series curve(const VirtualTrial& trial, const std::string& label,
                       const analysis::Look& look, const auto& value) {
  analysis::Series series{label, analysis::Mark::kLine, look};
  const std::size_t step = every_so_many(trial.times.size());
  for (std::size_t i = 0; i < trial.times.size(); i += step) {
    series.x.push_back(trial.times[i]);
    series.y.push_back(value(i));
  }
  return series;
}

/// Lines where stages begin.
analysis::Series stage_marks(const VirtualTrial& trial, double low, double high) {
  analysis::Series marks{
      "", analysis::Mark::kSegments, {palette::kGrey, palette::kShort, 7, 1.0, 1.0}};
  for (const VirtualStage& stage : trial.stages) {
    marks.x.push_back(stage.begin);
    marks.x2.push_back(stage.begin);
    marks.y.push_back(low);
    marks.y2.push_back(high);
  }
  return marks;
}

analysis::Figure figure_of(const VirtualTrial& trial, const std::string& name,
                           const std::string& what, const std::string& unit,
                           std::vector<analysis::Series> series) {
  double low = 0.0, high = 0.0;
  for (const analysis::Series& each : series) {
    for (const double y : each.y) {
      low = std::min(low, y);
      high = std::max(high, y);
    }
  }
  analysis::Figure figure;
  figure.name = "virtual-" + name;
  figure.title = what + " over time";
  figure.x_label = "time in the trial [s]";
  figure.y_label = fmt::format("{} [{}]", name, unit);
  figure.x_range = {0.0, std::max(trial.times.back(), 1e-3)};
  figure.height = 0.38;
  figure.simulated = true;
  figure.who = "PARTICIPANT";
  figure.caption = trial.stages.empty() ? "Simulated." : "Simulated. Grey lines: a stage begins.";
  figure.alt =
      fmt::format("{} of a virtual participant, from {:.3g} to {:.3g} {}.", what, low, high, unit);
  series.push_back(stage_marks(trial, low, high));
  figure.series = std::move(series);
  return figure;
}

std::vector<analysis::Series> curves_of(const VirtualTrial& trial,
                                        const std::vector<Eigen::Vector3d>& vectors, double unit) {
  std::vector<analysis::Series> all;
  for (int axis = 0; axis < 3; ++axis) {
    all.push_back(curve(trial, kAxisNames[static_cast<std::size_t>(axis)],
                        kLooks[static_cast<std::size_t>(axis)],
                        [&](std::size_t i) { return vectors[i][axis] / unit; }));
  }
  return all;
}

void add_virtual_figures(const VirtualTrial& trial, Preview& preview) {
  constexpr double kMillimetre = 1e-3;  // [m]
  preview.add(figure_of(trial, "position", "Position of the tip", "mm",
                        curves_of(trial, trial.positions, kMillimetre)));
  preview.add(figure_of(
      trial, "speed", "Speed of the tip", "m/s",
      {curve(trial, "", kLooks[0], [&](std::size_t i) { return trial.velocities[i].norm(); })}));
  preview.add(
      figure_of(trial, "force", "Force of the device", "N", curves_of(trial, trial.forces, 1.0)));
}

/// The film of the trial.
void add_film(const VirtualTrial& trial, Preview& preview) {
  analysis::Figure figure;
  figure.name = "film";
  figure.title = "The trial as a film";
  figure.caption =
      "SIMULATED PARTICIPANT. Dot: hand. Arrow: force of the device. Grey: the hand's way. Lines: "
      "objects, places, path. Before it is played, the strongest force.";
  figure.alt = fmt::format(
      "The simulated hand and the force on it, from the front and from above, over {:.3g} s.",
      trial.times.back());
  preview.add(std::move(figure), film_svg(trial, preview.objects, preview.language));
}

void add_virtual_table(const VirtualTrial& trial, Preview& preview) {
  std::vector<std::vector<std::string>> rows;
  for (const VirtualStage& stage : trial.stages) {
    rows.push_back(
        {stage.interval > 0 ? fmt::format("{}: {}", stage.interval, stage.name) : stage.name,
         fmt::format("{:.3f}", stage.begin), fmt::format("{:.3f}", stage.end - stage.begin)});
  }
  if (!rows.empty()) {
    preview.document.table({"interval: stage", "begins [s]", "lasts [s]"}, rows,
                           "Stages of the simulated trial");
  }
}

/// Description, warnings and texts that cannot be drawn: the lines of `haptrial validate`.
void add_checks(const Experiment& experiment, Preview& preview) {
  preview.document.heading("Checks");
  std::vector<std::string> warnings = warnings_of(experiment);
  std::ranges::move(undrawable_texts(experiment), std::back_inserter(warnings));
  for (const std::string& warning : warnings) {
    preview.document.alarm("Warning: " + warning);
  }
  if (warnings.empty()) {
    preview.document.paragraph("The definition is valid, and nothing is warned about.");
  }
  preview.document.points(experiment.definition->description());
}

}  // namespace

protocols::SessionPlace previewed_session(std::uint64_t seed, int participant) {
  protocols::SessionPlace place;
  place.subject = participant_name(participant);
  place.participant = participant;
  place.seed = seed;
  give_seeds(place);
  return place;
}

void add_objects(Preview& preview) {
  if (preview.objects.empty()) {
    return;
  }
  std::vector<std::string> names;
  for (const SpaceObject& object : preview.objects) {
    names.push_back(object.name);
  }
  preview.document.heading("Objects and places");
  analysis::Figure figure;
  figure.name = "objects";
  figure.title = "Objects and places of the trial";
  figure.caption = "As lines, meshes thinned. Turn them with the pointer or the sliders.";
  figure.alt = fmt::format("Lines of {}.", fmt::join(names, ", "));
  preview.add(std::move(figure), turned_svg(preview.objects, preview.language));
}

namespace {

bool is_simulated_whole(const protocols::Definition& definition) {
  return definition.longest(1) <= kLongestTrial;
}

VirtualTrial virtual_trial_of(const Experiment& experiment, const PreviewRequest& request) {
  const protocols::Definition& definition = *experiment.definition;
  return virtual_trial(experiment.study->protocol(), definition, previewed_session(request.seed),
                       request.trial,
                       is_simulated_whole(definition) ? kLongestTrial : kFirstSeconds);
}

void add_virtual_trial(const protocols::Definition& definition, const VirtualTrial& trial,
                       Preview& preview) {
  preview.document.heading("The trial of a virtual participant");
  preview.document.paragraph(
      "SIMULATED: nobody did this trial. A virtual participant, as in a dry run with the same "
      "seed, holds a virtual device; earlier trials of the session are taken as done, without "
      "answers.");
  if (!is_simulated_whole(definition)) {
    preview.document.paragraph(fmt::format(
        "A trial takes up to {:.0f} s. These are its first {:g} s; haptrial dry-run simulates all.",
        definition.longest(1), kFirstSeconds));
  } else if (!trial.completed) {
    preview.document.alarm("The simulated trial was not completed: " + trial.why);
  }
  if (trial.times.empty()) {
    return;
  }
  if (!trial.answers.empty()) {
    preview.document.paragraph(
        fmt::format("Simulated answers: {}.", fmt::join(trial.answers, "; ")));
  }
  add_film(trial, preview);
  add_virtual_figures(trial, preview);
  add_virtual_table(trial, preview);
}

}  // namespace

Preview preview_of(const Experiment& experiment, const PreviewRequest& request) {
  Preview preview;
  const protocols::Definition& definition = *experiment.definition;
  std::future<VirtualTrial> trial;  // meanwhile
  if (request.virtual_trial) {
    trial = std::async(std::launch::async, [&] { return virtual_trial_of(experiment, request); });
  }
  preview.language = request.language;
  preview.document.title = "Preview of " + definition.name;
  preview.document.subtitle = fmt::format(
      "{}, trial {} of the first session of participant S01, seed {}. Nobody has run it: "
      "what is shown is computed from the definition.",
      definition.file_name, request.trial, request.seed);
  preview.document.simulated = request.virtual_trial;
  add_checks(experiment, preview);
  experiment.study->add_preview(definition, request, preview);
  if (trial.valid()) {
    add_virtual_trial(definition, trial.get(), preview);
  }
  preview.document.source(definition.file_name, definition.text);
  preview.draw_figures();
  return preview;
}

}  // namespace haptrial::experiments
