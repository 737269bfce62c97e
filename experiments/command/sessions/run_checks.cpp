#include "experiments/command/sessions/run_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>

#include "core/base/counted.h"
#include "core/base/error.h"
#include "core/base/nearest.h"
#include "core/record/hdf5/file_lock.h"
#include "core/record/hdf5/session_target.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/read/session_reader.h"
#include "core/record/recovery/session_resume.h"
#include "experiments/command/arguments.h"
#include "experiments/runner/devices.h"
#include "experiments/studies/registry.h"
#include "experiments/study/session_name.h"
#include "experiments/study/study_files.h"
#include "protocols/definition/definition.h"
#include "protocols/interface/protocol.h"
#include "protocols/interface/recorded_definition.h"
#include "protocols/interface/study_rules.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

/// An identifier becomes a file name: no path may hide in it.
void check_subject(const std::string& subject) {
  constexpr std::size_t kLongest = 64;
  const bool plain = std::all_of(subject.begin(), subject.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_';
  });
  if (subject.empty() || subject.size() > kLongest || !plain) {
    throw InputError(fmt::format("--subject is '{}'; allowed: 1 to {} letters, digits, '-' and '_'",
                                 subject, kLongest));
  }
}

void check_device(const RunOptions& options) {
  for (const std::string& device : options.devices) {
    check_device_name(device);
    if ((device == "mouse" || device == "gamepad") && !options.window) {
      throw InputError(fmt::format(
          "--device {} takes its pointer from the participant's screen; add --window", device));
    }
    if (options.devices.size() == 1 || takes_library(device)) {
      check_library(device, options.library);
    }
    if (options.resume && replayed_file(device)) {
      throw InputError(
          "--resume is given with --device replay:FILE, which begins at the recording's first "
          "pass; leave out --resume and choose another --out");
    }
  }
}

void check_console(const RunOptions& options) {
  const auto need = [&options](const char* name, bool given) {
    if (given && !options.console) {
      throw InputError(
          fmt::format("{} is given without --console; leave it out or add --console", name));
    }
  };
  need("--port", options.port.has_value());
  need("--address", options.address.has_value());
  need("--remote", options.remote);
  need("--watch", !options.watch.empty());
}

void check_link(const RunOptions& options) {
  const bool linked = options.teach || !options.learn_from.empty();
  if (options.teach && !options.learn_from.empty()) {
    throw InputError("--teach and --learn-from are both given; a session is one side of a pair");
  }
  if (linked && options.secret.empty()) {
    throw InputError(
        "--teach and --learn-from need --secret FILE, the same on both sides; haptrial secret FILE "
        "makes one");
  }
  if (!linked && !options.secret.empty()) {
    throw InputError("--secret is given without --teach or --learn-from; leave it out");
  }
  if (linked && !options.tutor.empty()) {
    throw InputError("--tutor is given beside --teach or --learn-from; leave out one of them");
  }
}

std::string unfinished_in(const fs::path& folder) {
  constexpr std::size_t kMost = 8;
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) {
    return "there is no such folder";
  }
  const std::vector<std::string> files = unfinished_sessions(folder);
  if (files.empty()) {
    return "no session in this folder is unfinished";
  }
  const auto shown = static_cast<long>(std::min(kMost, files.size()));
  return fmt::format("unfinished in this folder: {}{}",
                     fmt::join(files.begin(), files.begin() + shown, ", "),
                     files.size() > kMost ? ", ..." : "");
}

/// Otherwise a mistyped --subject or --out would start a session anew.
void check_resumed(const fs::path& file) {
  if (!record::SessionWriter::can_resume(file)) {
    throw InputError(fmt::format(
        "{}: nothing to resume: {} is not there; {}; choose another --subject or --out, or leave "
        "out --resume",
        file.parent_path().string(), record::partial_path(file).filename().string(),
        unfinished_in(file.parent_path())));
  }
}

struct EarlierSession {
  fs::path file;
  record::SessionInfo info;
};

/// Sessions of the same kind in the folder, finished or not, by name. A file that cannot be read
/// says nothing about the study: `analyze` names it.
/// @param own  file of the session that is to be recorded
std::vector<EarlierSession> earlier_sessions(const fs::path& folder, bool pilot,
                                             const fs::path& own) {
  std::vector<EarlierSession> sessions;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const fs::path& file = entry.path();
    const bool same = file == own || file == record::partial_path(own) ||
                      file.stem().stem() == own.stem();  // or what was recovered of it
    if (same || (file.extension() != ".h5" && file.extension() != ".partial")) {
      continue;  // its own is looked at when it is resumed
    }
    try {
      const record::SessionInfo info = record::SessionReader(file).info();
      if (info.pilot == pilot) {
        sessions.push_back({file, info});
      }
    } catch (const InputError&) {
    }
  }
  std::sort(sessions.begin(), sessions.end(),
            [](const auto& a, const auto& b) { return a.file < b.file; });
  return sessions;
}

bool same_but_for_case(const std::string& one, const std::string& other) {
  return std::ranges::equal(one, other, [](unsigned char a, unsigned char b) {
    return std::tolower(a) == std::tolower(b);
  });
}

/// "p01" beside "P01" would be somebody else, who never came before.
void refuse_other_case(const RunOptions& options, const EarlierSession& earlier) {
  const std::string& theirs = earlier.info.subject;
  if (theirs != options.subject && same_but_for_case(theirs, options.subject)) {
    throw InputError(
        fmt::format("--subject is '{}', and {} is of '{}'; write the same participant in the same "
                    "way, or choose a name that differs in more than capitals",
                    options.subject, earlier.file.string(), theirs));
  }
}

/// Two people with one identifier could be neither excluded nor withdrawn apart.
void refuse_excluded(const RunOptions& options) {
  std::vector<EarlierSession> known =
      earlier_sessions(fs::path(options.out) / kExcludedFolder, false, {});
  const auto of = [&known](const std::string& subject) {
    return std::ranges::find_if(known, [&](const EarlierSession& each) {
      return same_but_for_case(each.info.subject, subject);
    });
  };
  const auto excluded = of(options.subject);
  if (excluded == known.end()) {
    return;
  }
  const std::string file = excluded->file.string();
  const int number = number_of_session(excluded->info);
  std::ranges::copy(earlier_sessions(options.out, false, {}), std::back_inserter(known));
  const std::string free = replacement_of(
      options.subject, [&](const std::string& name) { return of(name) != known.end(); });
  throw InputError(fmt::format(
      "--subject is '{}', and {} is of an excluded participant with that identifier; "
      "choose another one, such as {}{}, which has the same number",
      options.subject, file, free,
      number > 0 && number != number_of_subject(free) ? fmt::format(" --participant {}", number)
                                                      : ""));
}

/// A recording plays the hand back, which answers by place, and silence; nobody presses its keys,
/// buttons and pedals again.
bool is_given_again(const record::ResponseRow& answer) {
  using Source = record::ResponseSource;
  const bool silence = answer.source == Source::kNone && !std::isfinite(answer.reaction_time);
  return silence || answer.source == Source::kPlace || answer.source == Source::kMeasured;
}

}  // namespace

void check_run_options(const RunOptions& options) {
  if (!options.subject.empty()) {
    check_subject(options.subject);
  }
  check_device(options);
  check_console(options);
  if (!options.set.empty() && !options.pilot) {
    throw InputError(
        "--set is given without --pilot; sessions of a study have the keys of its definition");
  }
  check_link(options);
  const std::vector<std::string> hands{"left", "right", "both", "ambidextrous"};
  const std::string& hand = options.person.handedness;
  if (!hand.empty() && std::ranges::find(hands, hand) == hands.end()) {
    throw InputError(not_allowed("--handedness", fmt::format("'{}'", hand), hands));
  }
  if (options.stream && options.stream_optional) {
    throw InputError(
        "--lsl and --lsl-optional are both given; leave out the one that is not meant");
  }
}

void check_session_file(const RunOptions& options, const fs::path& file) {
  if (options.resume) {
    check_resumed(file);
    return;
  }
  std::error_code ignored;
  if (fs::exists(file, ignored)) {
    throw InputError(
        fmt::format("{}: {} already has a session here; choose another --subject or --out",
                    file.string(), options.subject));
  }
  const fs::path partial = record::partial_path(file);
  if (fs::exists(partial, ignored) && !record::FileLock::taken(partial)) {
    throw InputError(fmt::format(
        "{}: {} has an unfinished session here; add --resume, or choose another --subject or --out",
        partial.string(), options.subject));
  }
}

std::string session_seed(const RunOptions& options, const fs::path& own) {
  if (!options.seed.empty()) {
    return options.seed;
  }
  if (options.resume && record::SessionWriter::can_resume(own)) {
    return fmt::to_string(record::read_unfinished(record::partial_path(own)).info.seed);
  }
  const std::vector<EarlierSession> earlier = earlier_sessions(options.out, options.pilot, own);
  return options.pilot || earlier.empty() ? "1" : fmt::to_string(earlier.front().info.seed);
}

std::string begun_language(const RunOptions& options, const protocols::Definition& setup) {
  const fs::path own = session_file(options, setup);
  std::string language;
  if (options.resume && options.language.empty() && record::SessionWriter::can_resume(own)) {
    for (const record::EventRow& event :
         record::read_unfinished(record::partial_path(own)).events) {
      language = event.kind == protocols::kLanguageEvent ? event.text : language;
    }
  }
  return language;
}

std::optional<int> recorded_number(const RunOptions& options, const fs::path& own) {
  std::vector<EarlierSession> sessions = earlier_sessions(options.out, options.pilot, own);
  if (options.resume && record::SessionWriter::can_resume(own)) {
    const fs::path partial = record::partial_path(own);
    sessions.insert(sessions.begin(), {partial, record::read_unfinished(partial).info});
  }
  const auto at = std::ranges::find_if(sessions, [&](const EarlierSession& each) {
    return each.info.subject == options.subject && recorded_number(each.info);
  });
  return at != sessions.end() ? recorded_number(at->info) : std::nullopt;
}

std::string check_study(const RunOptions& options, const protocols::Protocol& protocol,
                        const protocols::Definition& setup, const fs::path& own) {
  std::string changed;
  if (!options.pilot) {
    refuse_excluded(options);
  }
  for (const EarlierSession& earlier : earlier_sessions(options.out, options.pilot, own)) {
    refuse_other_case(options, earlier);
    if (options.pilot) {
      continue;  // each pilot may try something else
    }
    const auto& [file, info] = earlier;
    const DefinitionChanges changes =
        protocols::study_changes(protocol, info, setup.text, options.devices.front());
    if (!changes.same_study()) {
      throw InputError(fmt::format(
          "{}: was recorded with another definition: {}; record each study into a folder of its "
          "own, chosen with --out",
          file.string(), sentence_of(changes.binding)));
    }
    if (!info.pilot && info.seed != checked_seed(options.seed)) {
      throw InputError(
          fmt::format("{}: was recorded with seed {}, not with {}; orders are balanced over the "
                      "sessions of one seed: leave out --seed, or choose another --out",
                      file.string(), info.seed, options.seed));
    }
    if (changed.empty() && !changes.free.empty()) {
      changed = fmt::format(
          "the definition differs from that of {}: {}; such keys may change within a study",
          file.filename().string(), sentence_of(changes.free));
    }
  }
  return changed;
}

void check_recording(const RunOptions& options, const protocols::Protocol& protocol,
                     const protocols::Definition& setup) {
  const int tips = protocols::tips_of(setup.arms());
  if (std::cmp_greater(options.devices.size(), tips)) {
    throw InputError(fmt::format("--device is given {} times; {} drives {}", options.devices.size(),
                                 setup.file_name, counted(tips, "device", "devices")));
  }
  const auto file = replayed_file(options.devices.front());
  if (!file) {
    return;
  }
  if (tips > 1) {
    throw InputError(
        fmt::format("--device replay:{}: a replay moves one device by one recorded "
                    "hand, and {} drives {}",
                    *file, setup.file_name, counted(tips, "device", "devices")));
  }
  const record::SessionReader reader(*file);
  const record::SessionInfo& info = reader.info();
  if (info.subject != options.subject) {
    throw InputError(fmt::format("{}: was recorded with subject {}; replay it with --subject {}",
                                 *file, info.subject, info.subject));
  }
  if (info.seed != checked_seed(options.seed)) {
    throw InputError(fmt::format("{}: was recorded with seed {}; replay it with --seed {}", *file,
                                 info.seed, info.seed));
  }
  // The recording stands in for the virtual hand, whose tables are not used.
  const DefinitionChanges changes = definition_changes(
      info.definition, setup.text, protocols::study_rules(protocol, protocols::Hand::kPerson));
  if (!changes.same_study()) {
    throw InputError(
        fmt::format("{}: was recorded with another definition: {}; replay it with the same one",
                    *file, sentence_of(changes.binding)));
  }
  protocol.check_replayed(setup, reader);
  const std::vector<record::ResponseRow> answers = reader.responses();
  const auto other = std::ranges::find_if_not(answers, is_given_again);
  if (!options.window && other != answers.end()) {
    throw InputError(
        fmt::format("{}: the answer '{}' of trial {} was not given by the hand, and a recording "
                    "plays back the hand alone; add --window and answer there, or go through the "
                    "trials with haptrial replay",
                    *file, other->question, other->trial));
  }
}

protocols::TutorChoice checked_tutor(const std::string& text, const protocols::Protocol& protocol) {
  protocols::TutorChoice tutor = protocols::read_tutor_choice(text);
  protocols::read_model(tutor);
  const protocols::Protocol& recorded = protocol_of(record::SessionReader(tutor.file).info());
  if (&recorded != &protocol) {
    throw InputError(
        fmt::format("--tutor: {} is a session of protocol '{}'; allowed: one of '{}', the protocol "
                    "of the definition",
                    tutor.file.string(), recorded.name(), protocol.name()));
  }
  return tutor;
}

void check_pages(const RunOptions& options, const protocols::Definition& setup) {
  const bool person = options.devices.front() != "virtual";
  if (person && !setup.pages.empty() && !options.window && !options.console && !options.keyboard) {
    throw InputError(
        "the definition has [pages], which nobody could read or answer; add --window, --console "
        "or --keyboard");
  }
}

}  // namespace haptrial::experiments
