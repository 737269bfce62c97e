#include "experiments/studies/force/force_preview.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "core/render/flat/trial_display.h"
#include "experiments/control/live_status.h"
#include "experiments/preview/fixed_plan.h"
#include "experiments/preview/preview_pictures.h"
#include "experiments/preview/trials_parts.h"
#include "protocols/force_training/guided_passes.h"

namespace haptrial::experiments {
namespace {

using protocols::ForceDefinition;
using protocols::GuidedPass;
using protocols::GuidedTrial;
using record::Stage;

constexpr std::array<Stage, 4> kStages{Stage::kApproach, Stage::kWait, Stage::kRun, Stage::kReturn};

std::string stage_words(const GuidedPass& pass, Stage stage) {
  return fmt::format("{}: {}", record::name_of(pass.phase), name_of(stage));
}

bool is_self_paced(const ForceDefinition& d) {
  return d.guidance.kind == protocols::Guidance::kCurve;
}

std::string end_of(const ForceDefinition& d, Stage stage) {
  const protocols::GuidanceParameters& g = d.guidance;
  switch (stage) {
    case Stage::kApproach:
      return fmt::format("when the guide is at the start; it moves at up to {:g} m/s",
                         g.approach_speed);
    case Stage::kWait:
      return fmt::format(
          "when the hand has been within {:g} mm of the start for {:g} s; aborted after {:g} s",
          1e3 * g.settle_distance, g.wait, g.wait_timeout);
    case Stage::kRun:
      return is_self_paced(d)
                 ? fmt::format("when the hand is at the path's end; aborted after {:g} s",
                               g.run_timeout)
                 : "when the path's time is over";
    default:
      return fmt::format("when the guide is back at the start; it moves at up to {:g} m/s",
                         g.approach_speed);
  }
}

bool waits(const ForceDefinition& d, Stage stage) {
  return stage == Stage::kApproach || stage == Stage::kWait ||
         (stage == Stage::kRun && is_self_paced(d));
}

void add_timeline(const ForceDefinition& d, const GuidedTrial& trial, const PreviewRequest& request,
                  Preview& preview) {
  std::vector<TimelineBar> bars;
  std::vector<std::vector<std::string>> rows;
  for (const GuidedPass& pass : trial.passes) {
    for (const Stage stage : kStages) {
      const std::string label = stage_words(pass, stage);
      const double lasts = pass.lasts(stage, d.rate);
      const bool open = waits(d, stage);
      bars.push_back(
          {label, fmt::format("{}{:.3g} s", open ? "at least " : "", lasts), lasts, open});
      rows.push_back({label, fmt::format("{:.3g}", lasts), end_of(d, stage)});
    }
  }
  preview.document.heading("One trial, stage by stage");
  preview.document.paragraph(fmt::format(
      "Trial {} of {} in the session: {} {} of block {}, condition {}. Durations are those of a "
      "hand that waits at the start and follows the path exactly. Trials of this protocol have no "
      "sounds and no questions; questionnaires stand beside the trials.{}",
      request.trial, trial.most, trial.plan.practice ? "practice" : "trial", trial.plan.trial,
      trial.plan.block, trial.plan.condition,
      d.session_plan(1).gives ? "" : " The first session only tests, and trains nobody."));
  preview.add(timeline_figure(bars.size()), timeline_svg(bars));
  preview.document.table({"stage", "lasts [s]", "ends"}, rows);
}

void add_seen(const ForceDefinition& d, const GuidedTrial& trial, Preview& preview) {
  constexpr int kWide = 640;  // [px]
  const int scale = (d.display.width + kWide - 1) / kWide;
  render::FrameRenderer renderer(d.display);
  renderer.set_trajectory(trial.stimulus.path.points());
  std::vector<GalleryPicture> pictures;
  std::vector<std::string> words;
  for (const GuidedPass& pass : trial.passes) {
    for (const Stage stage : kStages) {
      if (const protocols::GuidedTick* tick = pass.middle_of(stage)) {
        const render::Image image = render::coarser(renderer.draw(tick->seen), scale);
        words.push_back(stage_words(pass, stage));
        pictures.push_back({render::png_bytes(image), image.width, image.height, words.back()});
      }
    }
  }
  preview.document.heading("What the participant sees");
  preview.add(gallery_figure(words,
                             "By the drawing of sessions, in the middle of each stage, with "
                             "a hand that follows the path exactly."),
              gallery_svg(pictures));
}

/// So many ticks draw a curve as well as all of them.
std::size_t every_so_many(std::size_t ticks) { return std::max<std::size_t>(1, ticks / 1000); }

void add_course(const ForceDefinition& d, const GuidedPass& pass, Preview& preview) {
  std::vector<const protocols::GuidedTick*> run;
  for (const protocols::GuidedTick& tick : pass.ticks) {
    if (tick.stage == Stage::kRun) {
      run.push_back(&tick);
    }
  }
  if (run.empty()) {
    return;
  }
  analysis::Series target{"target force, upward", analysis::Mark::kLine, curve_look(3)};
  std::vector<analysis::Series> series;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    series.push_back({fmt::format("{}-force on the hand", kAxisNames[axis]), analysis::Mark::kLine,
                      curve_look(axis)});
  }
  series.push_back(target);
  for (std::size_t i = 0; i < run.size(); i += every_so_many(run.size())) {
    for (std::size_t axis = 0; axis < 4; ++axis) {
      series[axis].x.push_back(static_cast<double>(i) / d.rate);
      series[axis].y.push_back(axis < 3 ? run[i]->force[static_cast<Eigen::Index>(axis)]
                                        : run[i]->target_force);
    }
  }
  const std::string phase = record::name_of(pass.phase);
  const auto [low, high] = std::ranges::minmax(series[3].y);
  analysis::Figure figure;
  figure.name = "force-" + phase;
  figure.title = "Force along the path: " + phase;
  figure.x_label = "time of the run [s]";
  figure.y_label = "force [N]";
  figure.height = 0.42;
  figure.caption = "On a hand that follows the path exactly, by the pass itself.";
  figure.alt = fmt::format("The target force is from {:.3g} to {:.3g} N over {:.3g} s.", low, high,
                           static_cast<double>(run.size()) / d.rate);
  figure.series = std::move(series);
  preview.add(std::move(figure));
}

void add_aside(const GuidedTrial& trial, Preview& preview) {
  analysis::Figure figure;
  figure.name = "force-aside";
  figure.title =
      fmt::format("Force beside the path: {}", record::name_of(trial.passes.front().phase));
  figure.x_label = "offset from the path [mm]";
  figure.y_label = "force on the hand [N]";
  figure.height = 0.42;
  figure.caption =
      "Along each axis, 0.1 s after the run has begun; along its own axis alone. By the pass "
      "itself.";
  std::string alt;
  for (const protocols::ForceAside& aside : trial.aside) {
    const char* axis = kAxisNames[static_cast<std::size_t>(aside.axis)];
    analysis::Series series{fmt::format("{}-force along {}", axis, axis), analysis::Mark::kLine,
                            curve_look(static_cast<std::size_t>(aside.axis))};
    for (std::size_t i = 0; i < aside.offsets.size(); ++i) {
      series.x.push_back(1e3 * aside.offsets[i]);
      series.y.push_back(aside.forces[i][aside.axis]);
    }
    alt += fmt::format("{}{}: {:.3g} to {:.3g} N", alt.empty() ? "" : "; ", series.label,
                       series.y.front(), series.y.back());
    figure.series.push_back(std::move(series));
  }
  figure.alt = alt + ".";
  preview.add(std::move(figure));
}

void add_gains(const ForceDefinition& d, Preview& preview) {
  const protocols::GuidanceParameters& g = d.guidance;
  const auto row = [](const std::string& name, const control::PdGains& gains) {
    return std::vector<std::string>{name, fmt::format("{:g}", gains.stiffness),
                                    fmt::format("{:g}", gains.damping)};
  };
  preview.document.table(
      {"spring", "stiffness [N/m]", "damping [N·s/m]"},
      {row("to the path (x and z)", g.trajectory), row("to the plane (y)", g.plane)});
  preview.document.paragraph(
      fmt::format("Guidance gives at most {:g} N. In haptic training the plane lets go during the "
                  "run, and the device pushes the hand up with the target force.",
                  g.force_limit));
}

/// Sessions that give nothing, for a methods section.
std::string words_of_tests(const ForceDefinition& d) {
  std::vector<std::string> names;
  for (int session = 1; session <= d.sessions(); ++session) {
    if (!d.session_plan(session).gives) {
      names.push_back(d.session_name(session));
    }
  }
  return names.empty() ? ""
                       : fmt::format(" Sessions without training had the test pass alone: {}.",
                                     fmt::join(names, ", "));
}

void add_plan(const ForceDefinition& d, std::uint64_t seed, analysis::Document& document) {
  add_fixed_plan(
      d,
      [&](int participant) {
        return protocols::planned_trials_of(d, previewed_session(seed, participant));
      },
      document);
}

}  // namespace

void add_force_methods(const ForceDefinition& d, std::uint64_t seed, analysis::Document& document) {
  const protocols::GuidanceParameters& g = d.guidance;
  document.heading("Stimuli and procedure");
  document.paragraph(fmt::format(
      "A trial was a training pass and then a test pass, in which the force was recalled.{} The "
      "plan "
      "has {} blocks, each with one path and one pattern of force {} times under one condition of "
      "training ({}). {}{}",
      words_of_tests(d), d.design.blocks(), d.design.repetitions,
      fmt::join(d.design.conditions, ", "),
      d.design.break_after > 0 ? fmt::format("Breaks of {:g} s came after every {} trials. ",
                                             d.design.break_duration, d.design.break_after)
                               : std::string(),
      d.design.practice > 0
          ? fmt::format("{} practice trials of each condition came first.", d.design.practice)
          : std::string("There was no practice.")));
  document.paragraph(fmt::format(
      "The hand was {} by a spring of {:g} N/m with {:g} N·s/m and held in the plane by {:g} N/m "
      "with "
      "{:g} N·s/m; forces were limited to {:g} N.{}",
      is_self_paced(d) ? "held on the path, at its own pace," : "led along the path in its time",
      g.trajectory.stiffness, g.trajectory.damping, g.plane.stiffness, g.plane.damping,
      g.force_limit, g.free_recall ? " Nothing led it in the test." : ""));
  add_plan(d, seed, document);
}

void add_force_preview(const ForceDefinition& d, const PreviewRequest& request, Preview& preview) {
  const GuidedTrial trial =
      protocols::guided_trial(d, previewed_session(request.seed), request.trial);
  add_timeline(d, trial, request, preview);
  add_seen(d, trial, preview);
  preview.objects = {{"path", 0, lines_of(trial.stimulus.path.points())}};
  preview.document.heading("What is felt");
  for (const GuidedPass& pass : trial.passes) {
    add_course(d, pass, preview);
  }
  add_aside(trial, preview);
  add_gains(d, preview);
  const protocols::GuidanceParameters& g = d.guidance;
  add_certified(d,
                {{"spring to the path", g.trajectory.stiffness, g.trajectory.damping},
                 {"spring to the plane", g.plane.stiffness, g.plane.damping}},
                preview);
  add_plan(d, request.seed, preview.document);
}

}  // namespace haptrial::experiments
