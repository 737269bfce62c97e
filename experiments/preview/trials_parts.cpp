#include "experiments/preview/trials_parts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <map>
#include <optional>

#include "core/base/counted.h"
#include "core/questions/question_kind.h"
#include "core/render/gl/image.h"
#include "experiments/preview/preview_pictures.h"

namespace haptrial::experiments {
namespace {

using protocols::PreviewedStage;
using protocols::PreviewedTrial;
using protocols::TrialsDefinition;

std::string listed(const std::vector<std::string>& words) {
  return words.empty() ? "none" : fmt::format("{}", fmt::join(words, ", "));
}

std::string duration_of(const PreviewedStage& stage) {
  return stage.fixed ? fmt::format("{:g}", stage.shortest)
         : std::isfinite(stage.longest)
             ? fmt::format("{:.3g} to {:g}", stage.shortest, stage.longest)
             : fmt::format("{:.3g} or more", stage.shortest);
}

std::string beside_bar(const PreviewedStage& stage) {
  std::string words = stage.fixed ? fmt::format("{:g} s", stage.shortest) : stage.ends;
  if (!stage.fixed && std::isfinite(stage.longest)) {
    words += fmt::format(", at most {:g} s", stage.longest);
  }
  return words + (stage.sound.empty() ? "" : ", sound " + stage.sound);
}

std::vector<TimelineBar> bars_of(const PreviewedTrial& trial) {
  std::vector<TimelineBar> bars;
  for (std::size_t i = 0; i < trial.intervals.size(); ++i) {
    const std::vector<PreviewedStage>& stages = trial.intervals[i].stages;
    for (std::size_t s = 0; s < stages.size(); ++s) {
      bars.push_back(
          {stage_name(trial, {i, s}), beside_bar(stages[s]), stages[s].shortest, !stages[s].fixed});
    }
  }
  for (const protocols::PreviewedQuestion& asked : trial.questions) {
    bars.push_back({"question: " + asked.question->name, "until it is answered", 0.0, true});
  }
  return bars;
}

}  // namespace

void add_stage_table(const PreviewedTrial& trial, analysis::Document& document) {
  const bool marked = std::ranges::any_of(trial.intervals.front().stages,
                                          [](const auto& stage) { return stage.marker > 0; });
  std::vector<std::string> heading{"stage", "lasts [s]", "ends", "fields", "shows", "sound"};
  if (marked) {
    heading.emplace_back("marker");
  }
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = 0; i < trial.intervals.size(); ++i) {
    for (std::size_t s = 0; s < trial.intervals[i].stages.size(); ++s) {
      const PreviewedStage& stage = trial.intervals[i].stages[s];
      std::vector<std::string> ends{stage.ends};
      for (const std::string& more : {stage.late, stage.requirement}) {
        if (!more.empty()) {
          ends.push_back(more);
        }
      }
      rows.push_back({stage_name(trial, {i, s}), duration_of(stage),
                      fmt::format("{}", fmt::join(ends, "; ")), listed(stage.fields),
                      listed(stage.shows), stage.sound.empty() ? "none" : stage.sound});
      if (marked) {
        rows.back().push_back(fmt::format("{}", stage.marker));
      }
    }
  }
  document.table(heading, rows);
}

namespace {

std::string answers_of(const protocols::TrialQuestion& question) {
  std::vector<std::string> answers;
  for (std::size_t i = 0; i < question.choices.size(); ++i) {
    const std::string& hint = question.means[i].hint;
    answers.push_back(question.choices[i].label + (hint.empty() ? "" : " [" + hint + "]"));
  }
  return answers.empty() ? question.kind->word() : fmt::format("{}", fmt::join(answers, ", "));
}

std::string words_of_timeout(const protocols::TrialQuestion& question) {
  const int silent = question.silent_choice();
  return silent < 0 ? fmt::format("after {:g} s the trial is aborted", question.timeout)
                    : fmt::format("after {:g} s the answer is {}", question.timeout,
                                  question.choices[static_cast<std::size_t>(silent)].label);
}

void add_questions(const PreviewedTrial& trial, Preview& preview) {
  std::vector<std::vector<std::string>> rows;
  for (const protocols::PreviewedQuestion& asked : trial.questions) {
    const protocols::TrialQuestion& question = *asked.question;
    rows.push_back(
        {question.text, answers_of(question),
         asked.right < 0 ? "none" : question.choices[static_cast<std::size_t>(asked.right)].label,
         asked.feedback ? "yes" : "no",
         question.timeout > 0.0 ? words_of_timeout(question) : "none"});
  }
  if (!rows.empty()) {
    preview.document.table({"question", "answers", "right here", "told", "time-out"}, rows);
  }
}

void add_values(const PreviewedTrial& trial, Preview& preview) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& [name, value] : trial.values) {
    rows.push_back({name, "trial", value});
  }
  for (std::size_t i = 0; i < trial.intervals.size(); ++i) {
    for (const auto& [name, value] : trial.intervals[i].values) {
      rows.push_back({name, fmt::format("{} {}", i + 1, trial.intervals[i].name), value});
    }
  }
  preview.document.table({"name", "holds in", "value"}, rows, "Values of the names in this trial");
}

/// @param shown  TrialsDefinition::shown_conditions()
std::string shown_condition(const std::map<std::string, std::string>& shown,
                            const std::string& recorded) {
  const auto known = shown.find(recorded);
  return known != shown.end() ? known->second : recorded;
}

std::string sentence_about(const TrialsDefinition& d, const PreviewedTrial& trial) {
  const protocols::PlannedTrial& plan = trial.next.plan;
  std::string words =
      fmt::format("Trial {} of at most {} in the session: {} {} of block {}, condition {}",
                  trial.number, trial.most, plan.practice ? "practice" : "trial", plan.trial,
                  plan.block_name, shown_condition(d.shown_conditions(), plan.condition));
  words +=
      trial.next.values.probe.empty() ? "" : fmt::format(", probe {}", trial.next.values.probe);
  words += ".";
  for (const auto& [name, level] : trial.next.values.levels) {
    words += fmt::format(" {} = {:g}, asked for by {} before any answer.", name, level,
                         trial.track.empty() ? "a procedure" : trial.track);
  }
  return words;
}

std::string number_or_range(int low, int high) {
  return low == high ? fmt::format("{}", low) : fmt::format("{} to {}", low, high);
}

void add_orders(const std::string& what, const std::vector<protocols::PlannedOrder>& orders,
                const char* counted_things, const std::string& folded,
                analysis::Document& document) {
  constexpr std::size_t kFew = 8;
  std::vector<std::vector<std::string>> rows;
  for (const protocols::PlannedOrder& order : orders) {
    rows.push_back({order.order, fmt::format("{}", order.count)});
  }
  if (!rows.empty()) {
    document.table({what, counted_things}, rows, rows.size() > kFew ? folded : "");
  }
}

/// The content of a picture, in words.
std::string content_of(const PreviewedTrial& trial, const protocols::SeenStage& seen) {
  if (seen.question >= 0) {
    return trial.questions[static_cast<std::size_t>(seen.question)].question->text;
  }
  const auto& [interval, stage] = seen.where.front();
  const std::vector<std::string>& shows = trial.intervals[interval].stages[stage].shows;
  return shows.empty() ? "nothing" : listed(shows);
}

/// The conditions of a block together.
void add_planned_blocks(const protocols::PlannedTrials& planned, analysis::Document& document) {
  std::vector<std::pair<std::string, int>> blocks;
  for (const protocols::PlannedCount& count : planned.counts) {
    const std::string name = count.block + (count.probe.empty() ? "" : ", probe " + count.probe);
    const auto known = std::ranges::find(blocks, name, &std::pair<std::string, int>::first);
    if (known == blocks.end()) {
      blocks.emplace_back(name, count.all);
    } else {
      known->second += count.all;
    }
  }
  std::vector<std::vector<std::string>> rows;
  for (const auto& [name, all] : blocks) {
    rows.push_back({name, fmt::format("{}", all)});
  }
  document.table({"block", "trials in all"}, rows);
}

}  // namespace

void add_timeline(const TrialsDefinition& d, const PreviewedTrial& trial, Preview& preview) {
  preview.document.heading("One trial, stage by stage");
  preview.document.paragraph(sentence_about(d, trial));
  const std::vector<TimelineBar> bars = bars_of(trial);
  preview.add(timeline_figure(bars.size()), timeline_svg(bars));
  add_stage_table(trial, preview.document);
  add_questions(trial, preview);
  add_values(trial, preview);
}

void add_seen(const PreviewedTrial& trial, const std::vector<protocols::SeenStage>& seen,
              Preview& preview) {
  preview.document.heading("What the participant sees");
  std::vector<GalleryPicture> pictures;
  std::vector<std::string> words;
  for (const protocols::SeenStage& each : seen) {
    const std::string where =
        each.question >= 0
            ? "question " + trial.questions[static_cast<std::size_t>(each.question)].question->name
            : stage_names(trial, each.where);
    pictures.push_back(
        {render::png_bytes(each.picture), each.picture.width, each.picture.height, where});
    words.push_back(where + ": " + content_of(trial, each));
  }
  preview.add(gallery_figure(words,
                             "By the drawing of sessions; the hand is where the trial starts. "
                             "Stages that look the same share a picture."),
              gallery_svg(pictures));
}

void add_planned(const TrialsDefinition& d, const protocols::PlannedTrials& planned,
                 analysis::Document& document) {
  document.heading("Trials of the study");
  document.paragraph(fmt::format("Counted over {}{}, by the code that plans sessions.",
                                 counted(planned.participants, "participant", "participants"),
                                 planned.participants < d.design.participants
                                     ? fmt::format(" of {}", d.design.participants)
                                     : ""));
  const bool sessions = d.order.sessions > 1;
  std::vector<std::string> heading{"block",        "condition",      "probe",
                                   "participants", "trials of each", "trials in all"};
  if (!planned.groups.empty()) {
    heading.insert(heading.begin(), "group");
  }
  if (sessions) {
    heading.insert(heading.begin(), "session");
  }
  const std::map<std::string, std::string> shown = d.shown_conditions();
  std::vector<std::vector<std::string>> rows;
  for (const protocols::PlannedCount& count : planned.counts) {
    const std::string most = count.open ? "at most " : "";
    std::vector<std::string> row{count.block + (count.practice ? " (practice)" : ""),
                                 shown_condition(shown, count.condition),
                                 count.probe.empty() ? "none" : count.probe,
                                 fmt::format("{}", count.participants),
                                 most + number_or_range(count.fewest, count.most),
                                 most + fmt::format("{}", count.all)};
    if (!planned.groups.empty()) {
      row.insert(row.begin(), count.group);
    }
    if (sessions) {
      row.insert(row.begin(), fmt::format("{}", count.session));
    }
    rows.push_back(std::move(row));
  }
  constexpr std::size_t kMany = 24;
  if (rows.size() > kMany) {
    add_planned_blocks(planned, document);
  }
  document.table(heading, rows, rows.size() > kMany ? "Trials of each condition" : "");
  add_orders("group", planned.groups, "participants", "", document);
  add_orders("order of blocks", planned.block_orders, "sessions", "Orders of blocks", document);
  add_orders("order of intervals", planned.interval_orders, "trials", "Orders of intervals",
             document);
}

void add_trials_parts(const protocols::StudiedDefinition& definition, const PreviewRequest& request,
                      Preview& preview) {
  constexpr int kPictureWidth = 640;      // [px]
  constexpr int kMostParticipants = 200;  // that are counted
  const PreviewedTrial trial =
      protocols::previewed_trial(definition, previewed_session(request.seed), request.trial);
  auto felt = std::async(std::launch::async, [&] {  // while pictures are drawn
    return protocols::felt_stages(definition, trial, request.look);
  });
  add_timeline(definition, trial, preview);
  add_seen(trial, protocols::seen_stages(definition, trial, kPictureWidth), preview);
  preview.objects = objects_of(trial);
  add_objects(preview);
  add_felt(definition, trial, felt.get(), preview);
  add_planned(definition, protocols::planned_trials(definition, request.seed, kMostParticipants),
              preview.document);
}

namespace {

std::string judged(const DeviceDemand& demand, const device::Certificate& certificate) {
  if (demand.stiffness <= 0.0) {
    return "no stiffness";
  }
  if (!std::isfinite(demand.stiffness)) {
    return "the force jumps, which no stiffness bounds";
  }
  if (!certificate.stiffest_wall) {
    return "not certified";
  }
  const double share = demand.stiffness / *certificate.stiffest_wall;
  return share <= 1.0 ? fmt::format("yes, {:.0f} % of it", 100.0 * share)
                      : fmt::format("no, {:.3g} times as stiff", share);
}

void add_figures(const device::Certificate& c, Preview& preview) {
  std::vector<std::vector<std::string>> rows;
  const auto add = [&](const char* name, const std::optional<double>& value, double unit,
                       const char* unit_name) {
    rows.push_back({name, value ? fmt::format("{:.4g} {}", *value / unit, unit_name)
                                : "not in the certificate"});
  };
  add("stiffest wall that stays passive", c.stiffest_wall, 1.0, "N/m");
  add("force measured per force commanded", c.gain, 1.0, "");
  add("longest command without a force", c.dead_zone, 1.0, "N");
  add("friction", c.friction, 1.0, "N");
  add("noise of the force", c.force_noise, 1.0, "N");
  add("delay of the force", c.delay, 1e-3, "ms");
  preview.document.table({"certified", "value"}, rows);
}

}  // namespace

void add_certified(const protocols::Definition& d, const std::vector<DeviceDemand>& demands,
                   Preview& preview) {
  preview.document.subheading("What the certified device presents");
  if (!d.certificate) {
    preview.document.paragraph(
        "The definition names no certificate of a device (device.certificate), so that the forces "
        "are not compared with what a device can present.");
    return;
  }
  const device::Certificate& certificate = *d.certificate;
  preview.document.paragraph(fmt::format(
      "Certificate {} of the device {}{}. It has no figure for damping, which is listed only.",
      certificate.file, certificate.device, certificate.simulated ? ", a virtual one" : ""));
  add_figures(certificate, preview);
  std::vector<std::vector<std::string>> rows;
  for (const DeviceDemand& demand : demands) {
    rows.push_back({demand.name, fmt::format("{:.4g}", demand.stiffness),
                    fmt::format("{:.4g}", demand.damping), judged(demand, certificate)});
  }
  preview.document.table(
      {"asked for by", "stiffness [N/m]", "damping [N·s/m]", "within the stiffest wall"}, rows);
}

}  // namespace haptrial::experiments
