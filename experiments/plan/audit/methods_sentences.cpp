#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <set>

#include "core/base/counted.h"
#include "experiments/plan/audit/study_methods.h"
#include "experiments/study/session_name.h"
#include "protocols/definition/groups.h"

namespace haptrial::experiments {
namespace {

using analysis::Document;
using Counts = std::map<std::string, int>;

/// "3 right, 1 left".
std::string method_words(const Counts& counts) {
  std::vector<std::string> words;
  for (const auto& [word, count] : counts) {
    words.push_back(fmt::format("{} {}", count, word));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

/// The first analysed session of each participant, by name.
std::map<std::string, const MethodsSession*> people_of(
    const std::vector<MethodsSession>& sessions) {
  std::map<std::string, const MethodsSession*> people;
  for (const MethodsSession& session : sessions) {
    if (session.analysed) {
      people.emplace(session.facts.info.subject, &session);
    }
  }
  return people;
}

/// Counts of a word over participants; "not recorded" if nobody has one.
std::string over_people(const std::map<std::string, const MethodsSession*>& people,
                        const std::function<std::string(const record::SessionInfo&)>& word_of) {
  Counts counts;
  for (const auto& [subject, session] : people) {
    const std::string word = word_of(session->facts.info);
    ++counts[word.empty() ? "not recorded" : word];
  }
  return counts.size() == 1 && counts.contains("not recorded") ? "not recorded"
                                                               : method_words(counts);
}

/// Sessions that are in the folder and not in the analysis, with the reason for each.
std::vector<std::string> left_out(const std::vector<MethodsSession>& sessions) {
  std::map<std::string, std::vector<std::string>> reasons;
  for (const MethodsSession& session : sessions) {
    if (!session.facts.name.empty() && session.facts.excluded) {
      reasons = exclusion_reasons(session.facts.file.parent_path().parent_path());
      break;
    }
  }
  std::vector<std::string> words;
  for (const MethodsSession& session : sessions) {
    const SessionFacts& facts = session.facts;
    if (session.analysed) {
      continue;
    }
    const auto reason = reasons.find(facts.info.subject);
    words.push_back(facts.name + ": " +
                    (!facts.unreadable.empty() ? "unreadable"
                     : facts.declined          ? "the participant did not consent"
                     : facts.excluded && reason != reasons.end()
                         ? fmt::format("excluded, {}", fmt::join(reason->second, "; "))
                     : facts.excluded   ? "excluded, no reason is recorded"
                     : facts.info.pilot ? "a pilot"
                                        : "another kind of session than those analysed"));
  }
  return words;
}

template <class Value>
std::string all_values(const std::vector<MethodsSession>& sessions, Value&& value) {
  std::set<std::string> words;
  for (const MethodsSession& session : sessions) {
    if (session.analysed) {
      words.insert(value(session));
    }
  }
  return fmt::format("{}", fmt::join(words, "; "));
}

/// @param before  the first figure
std::string figure_words(const device::CertifiedForce& c, const char* before, const char* force,
                         const char* stiffness) {
  std::string words;
  const auto add = [&](const char* name, const std::optional<double>& value, const char* unit) {
    if (value) {
      words += fmt::format("; {}{} {:.4g}{}", words.empty() ? before : "", name, *value, unit);
    }
  };
  add("gain", c.gain, "");
  add("dead zone", c.dead_zone, force);
  add("friction", c.friction, force);
  add("force noise", c.force_noise, force);
  add("delay", c.delay, " s");
  add("stiffest passive wall", c.stiffest_wall, stiffness);
  return words;
}

std::string certificate_words(const protocols::Definition& d) {
  if (!d.certificate) {
    return "No certificate of the device is recorded.";
  }
  const device::Certificate& c = *d.certificate;
  std::string words = fmt::format("The device's certificate {} ({}{})", c.file, c.device,
                                  c.simulated ? ", simulated" : "");
  words += figure_words(c, "", " N", " N/m");
  if (c.rotation) {
    words += figure_words(*c.rotation, "of the rotation: ", " N·m", " N·m/rad");
  }
  if (c.grip) {
    words += figure_words(*c.grip, "of the grip: ", " N", " N/m");
  }
  return words + ".";
}

std::string loop_words(const std::vector<MethodsSession>& sessions) {
  std::uint64_t ticks = 0, overruns = 0;
  for (const MethodsSession& session : sessions) {
    ticks += session.ticks;
    overruns += session.overruns;
  }
  return ticks == 0 ? std::string("The files do not say how the loop kept time.")
                    : fmt::format("Of {} ticks of the loop {} began later than a period.", ticks,
                                  overruns);
}

/// Trials of a session that a tutor led, and all; those that count alone.
std::array<int, 2> led_trials(const MethodsSession& session, const protocols::Definition& d,
                              const std::string& group) {
  std::set<int> led, all;
  const int participant = std::max(1, number_of_session(session.facts.info)) - 1;
  for (const record::PassRow& pass : session.passes) {
    if (!pass.practice) {
      all.insert(pass.trial);
      if (!session.tutor.empty() && d.is_led(static_cast<int>(session.facts.info.session),
                                             {pass.trial, participant, group})) {
        led.insert(pass.trial);
      }
    }
  }
  return {static_cast<int>(led.size()), static_cast<int>(all.size())};
}

/// Says how many trials a tutor led, by group; nothing without a tutor.
void add_led(const std::vector<MethodsSession>& sessions, const protocols::Definition& d,
             Document& document) {
  std::map<std::string, std::array<int, 2>> counts;
  std::set<std::string> tutors;
  for (const MethodsSession& session : sessions) {
    if (session.analysed) {
      const std::string group =
          d.groups.size() > 1 ? protocols::group_of(d.groups, session.facts.info.subject) : "";
      const auto [led, all] = led_trials(session, d, group);
      counts[group][0] += led;
      counts[group][1] += all;
      if (led > 0) {
        tutors.insert(session.tutor);
      }
    }
  }
  if (tutors.empty()) {
    return;
  }
  std::vector<std::string> words;
  for (const auto& [group, count] : counts) {
    words.push_back(fmt::format("{}{} of {}", group.empty() ? "" : group + " ", count[0],
                                counted(static_cast<std::size_t>(count[1]), "trial", "trials")));
  }
  document.paragraph(fmt::format("A tutor led the hand ({}): {}.", fmt::join(tutors, "; "),
                                 fmt::join(words, ", ")));
}

}  // namespace

bool all_imported(const std::vector<MethodsSession>& sessions) {
  return std::ranges::all_of(sessions, [](const MethodsSession& session) {
    return !session.analysed || !session.imported.empty();
  });
}

void add_imported(const std::vector<MethodsSession>& sessions, Document& document) {
  const auto imported = std::ranges::count_if(
      sessions, [](const MethodsSession& session) { return !session.imported.empty(); });
  if (imported == 0) {
    return;
  }
  document.heading("Imported sessions");
  document.paragraph(fmt::format(
      "Another program ran {} and wrote the {}. Its devices, forces, clock and screen, how many "
      "participants and trials were planned, in what order stimuli came, and what participants "
      "were told are not known here.",
      counted(imported, "session", "sessions"),
      imported == 1 ? "table that it was imported from" : "tables that they were imported from"));
}

void add_participants(const std::vector<MethodsSession>& sessions, const protocols::Definition& d,
                      Document& document) {
  const auto people = people_of(sessions);
  const auto analysed = std::ranges::count_if(sessions, &MethodsSession::analysed);
  const bool simulated = std::ranges::any_of(
      people, [](const auto& each) { return each.second->facts.info.simulated; });
  document.heading("Participants");
  std::string words = fmt::format(
      "{}{} in {}{}.", counted(people.size(), "participant is", "participants are"),
      simulated ? " simulated (programs in the place of people) and analysed" : " analysed",
      counted(analysed, "session", "sessions"),
      all_imported(sessions)
          ? std::string()
          : fmt::format("; {} planned", counted(d.design.participants, "was", "were")));
  if (d.groups.size() > 1) {
    words += fmt::format(" Groups: {}.", over_people(people, [&](const auto& info) {
                           return protocols::group_of(d.groups, info.subject);
                         }));
  }
  if (!simulated) {
    const auto of = [&](std::string record::Participant::*part) {
      return over_people(people, [&](const auto& info) { return info.participant.*part; });
    };
    words += fmt::format(" Handedness: {}. Sex: {}. Age: {}.", of(&record::Participant::handedness),
                         of(&record::Participant::sex), of(&record::Participant::age_band));
  }
  if (d.mirror_left_handed) {
    words += " Left-handed participants had the mirror image of the task.";
  }
  document.paragraph(words);
  const std::vector<std::string> others = left_out(sessions);
  document.paragraph(others.empty()
                         ? "No session in the folder was left out of the analysis."
                         : fmt::format("Left out of the analysis: {}.", fmt::join(others, "; ")));
}

void add_apparatus(const std::vector<MethodsSession>& sessions, const protocols::Definition& d,
                   Document& document) {
  document.heading("Apparatus");
  document.paragraph(fmt::format(
      "Device: {}. Clock: {}. Forces were computed and the hand recorded at {} Hz. {} The "
      "commanded "
      "force was limited to {:g} N and {:g} N/s, the workspace to a radius of {:g} m and the "
      "hand's speed to {:g} m/s; a reading beyond them ended the trial. {}",
      all_values(sessions,
                 [](const auto& session) {
                   const record::SessionInfo& info = session.facts.info;
                   return fmt::format("{} ({:g} N at most, workspace of {:g} m radius)",
                                      info.device, info.device_max_force,
                                      info.device_workspace_radius);
                 }),
      all_values(sessions, [](const auto& session) { return session.facts.info.clock; }),
      all_values(sessions,
                 [](const auto& session) { return fmt::format("{:g}", session.facts.info.rate); }),
      loop_words(sessions), d.envelope.max_force, d.envelope.max_force_rate,
      d.envelope.workspace_radius, d.envelope.max_speed, certificate_words(d)));
  const auto seen = std::ranges::count_if(sessions, &MethodsSession::seen);
  const auto analysed = std::ranges::count_if(sessions, &MethodsSession::analysed);
  document.paragraph(fmt::format(
      "{} Recorded by haptrial {}.",
      seen > 0 ? fmt::format("Participants saw a window for which pictures of {} by {} pixels were "
                             "drawn ({} of {} sessions recorded frames).",
                             d.display.width, d.display.height, seen, analysed)
               : std::string("No session recorded that a window was shown."),
      all_values(sessions, [](const auto& session) {
        const record::SessionInfo& info = session.facts.info;
        return fmt::format("{} ({})", info.program_version, info.program_commit);
      })));
}

/// Trials of imported sessions: counts alone.
static void add_counts(const std::vector<MethodsSession>& sessions, Document& document) {
  Counts trials;
  for (const MethodsSession& session : sessions) {
    for (const record::PassRow& pass : session.passes) {
      ++trials[fmt::format("{}", pass.condition)];
    }
  }
  std::vector<std::vector<std::string>> rows;
  for (const auto& [condition, count] : trials) {
    rows.push_back({condition, fmt::format("{}", count)});
  }
  document.heading("Trials as imported");
  document.table({"condition", "trials"}, rows);
}

void add_done(const std::vector<MethodsSession>& sessions, const protocols::Definition& d,
              Document& document) {
  if (all_imported(sessions)) {
    add_counts(sessions, document);
    return;
  }
  const std::map<std::string, std::string> shown = d.shown_conditions();
  std::map<std::string, std::array<int, 2>> passes;  // completed, aborted
  std::vector<std::vector<std::string>> rows;
  for (const MethodsSession& session : sessions) {
    if (!session.analysed) {
      continue;
    }
    const record::TrialProgress& p = session.facts.progress;
    rows.push_back({session.facts.info.subject, fmt::format("{}", session.facts.info.session),
                    p.planned ? fmt::format("{}", *p.planned) : "not known",
                    fmt::format("{}", p.done), fmt::format("{}", p.skipped),
                    fmt::format("{}", p.aborted), p.ended_early.empty() ? "–" : p.ended_early});
    for (const record::PassRow& pass : session.passes) {
      // An import has the order of the definition already.
      const auto known = session.imported.empty() ? shown.find(pass.condition) : shown.end();
      const std::string& condition = known != shown.end() ? known->second : pass.condition;
      auto& counts = passes[fmt::format("{}{}", pass.practice ? "practice: " : "", condition) +
                            "\n" + name_of(pass.phase)];
      ++counts[pass.status == record::PassStatus::kCompleted ? 0 : 1];
    }
  }
  document.heading("Trials as done");
  std::vector<std::vector<std::string>> conditions;
  for (const auto& [name, counts] : passes) {
    const auto cut = name.find('\n');
    conditions.push_back({name.substr(0, cut), name.substr(cut + 1), fmt::format("{}", counts[0]),
                          fmt::format("{}", counts[1])});
  }
  constexpr std::size_t kMany = 24;
  document.table({"condition", "pass", "completed", "aborted"}, conditions,
                 conditions.size() > kMany ? "Passes of each condition" : "");
  add_led(sessions, d, document);
  document.table({"participant", "session", "trials planned at most", "done", "skipped",
                  "never completed", "ended early"},
                 rows, rows.size() > kMany ? "Trials of each session" : "");
}

}  // namespace haptrial::experiments
