#include "experiments/runner/session_opening.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <utility>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/fnv.h"
#include "core/device/mouse.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/answer_rows.h"
#include "core/record/rows/common_tables.h"
#include "core/record/rows/device_rows.h"
#include "core/record/rows/marker_row.h"
#include "core/record/rows/trial_facts.h"
#include "experiments/control/signals.h"
#include "experiments/runner/version.h"
#include "experiments/screen/frame_pacing.h"
#include "protocols/definition/speech_options.h"
#include "protocols/interface/study_rules.h"

namespace haptrial::experiments {

DefinitionChanges changes_since(const SessionRequest& request, const record::SessionInfo& before) {
  return protocols::study_changes(*request.protocol, before, request.definition->text,
                                  request.device.name);
}

namespace {

/// A session that was led goes on with the same tutor, and no other begins to be led.
void check_same_tutor(const SessionRequest& request, const record::SessionReader& before) {
  std::string was;
  for (const record::EventRow& event : before.events()) {
    was = event.kind == "tutor" ? event.text : was;
  }
  const std::string is = tutor_text(request);
  const bool nothing_yet = was.empty() && before.begun().empty() && before.passes().empty();
  if (was != is && !nothing_yet) {
    throw InputError(fmt::format("{}: was recorded {}; resume it {}, not {}",
                                 before.path().string(),
                                 was.empty() ? "without a tutor" : "with the tutor " + was,
                                 was.empty() ? "without a tutor" : "with the same one",
                                 is.empty() ? "without one" : "with " + is));
  }
}

/// Checks the facts that a resumed session must have in common with the one that is gone on with.
void check_same_session(const SessionRequest& request, const device::DeviceInfo& device,
                        const record::SessionInfo& before) {
  const std::string partial = request.file.string() + ".partial";
  if (before.seed != request.seed) {
    throw InputError(
        fmt::format("{}: was recorded with seed {}; resume it with the same one, not with {}",
                    partial, before.seed, request.seed));
  }
  const DefinitionChanges changes = changes_since(request, before);
  if (!changes.same_study()) {
    throw InputError(
        fmt::format("{}: was recorded with another definition: {}; resume it with the same one",
                    partial, sentence_of(changes.binding)));
  }
  if (before.pilot != request.pilot) {
    throw InputError(fmt::format("{}: was recorded as {}; resume it {} --pilot", partial,
                                 before.pilot ? "a pilot" : "part of the study",
                                 before.pilot ? "with" : "without"));
  }
  if (request.definition->mirror_left_handed &&
      before.participant.handedness != request.person.handedness) {
    throw InputError(fmt::format("{}: was recorded with --handedness {}; resume it with the same",
                                 partial, before.participant.handedness));
  }
  if (before.session != static_cast<std::uint64_t>(request.session)) {
    throw InputError(fmt::format("{}: was recorded as session {}; resume it with --session {}",
                                 partial, before.session, before.session));
  }
  const auto number = static_cast<std::uint64_t>(request.participant) + 1;
  if (before.participant_number != 0 && before.participant_number != number) {
    throw InputError(fmt::format(
        "{}: was recorded in the order of participant {}; resume it with --participant {}, not {}",
        partial, before.participant_number, before.participant_number, number));
  }
  if (before.simulated != device.simulated) {
    throw InputError(fmt::format(
        "{}: was recorded with {}; resume it with --device {}, not {}", partial,
        before.simulated ? "a virtual participant" : "a person, on the device " + before.device,
        before.device, request.device.name));
  }
}

}  // namespace

record::SessionInfo session_info(const SessionRequest& request, const device::DeviceInfo& device) {
  const protocols::Definition& d = *request.definition;
  record::SessionInfo info;
  info.program_version = program_version();
  info.program_commit = program_commit();
  info.definition = d.text;
  info.definition_name = d.file_name;
  info.subject = request.subject;
  info.seed = request.seed;
  info.device = request.device.name;
  info.device_max_force = device.max_force;
  info.device_workspace_radius = device.workspace_radius;
  info.clock = request.clock == realtime::ClockKind::kReal ? "real" : "simulated";
  info.rate = d.rate;
  info.start_utc = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  info.simulated = device.simulated;
  info.pilot = request.pilot;
  info.session = static_cast<std::uint64_t>(request.session);
  info.participant_number = static_cast<std::uint64_t>(request.participant) + 1;
  info.participant = request.person;
  return info;
}

std::string device_change(const SessionRequest& request, const record::SessionInfo& before) {
  if (before.device.empty() || before.device == request.device.name) {
    return "";
  }
  return fmt::format("goes on with the device {}, though it began with {}, which its file names",
                     request.device.name, before.device);
}

std::string tutor_text(const SessionRequest& request) {
  if (request.link) {
    return fmt::format("in another session, which this one {}",
                       request.link->role == protocols::LinkRole::kTeaches ? "teaches" : "follows");
  }
  if (!request.tutor) {
    return "";
  }
  const protocols::TutorChoice& tutor = *request.tutor;
  return fmt::format("{} trial {} from {} s, checksum {:016x}", tutor.file.filename().string(),
                     tutor.trial.value_or(0), tutor.from, fnv1a(file_text(tutor.file)));
}

/// Tables of channels, of outcomes of trials, of further devices and of markers.
static record::TableList stated_tables(const SessionRequest& request,
                                       const channel::ChannelSet& channels) {
  record::TableList tables = channels.tables();
  tables.push_back(&record::table_of<record::SkippedRow>());
  tables.push_back(&record::table_of<record::TakenBackRow>());
  tables.push_back(&record::table_of<record::DampingRow>());
  if (!request.definition->pages.empty()) {
    tables.push_back(&record::table_of<record::AnswerRow>());
  }
  if (request.definition->devices() > 1) {
    tables.push_back(&record::table_of<record::DeviceRow>());
  }
  if (request.definition->markers.used) {
    tables.push_back(&record::table_of<record::MarkerRow>());
  }
  return tables;
}

static record::TableList tables_of(const SessionRequest& request, const protocols::Trials& trials,
                                   const channel::ChannelSet& channels) {
  return record::with_tables(trials.tables(), stated_tables(request, channels));
}

/// Tables that its file may have already: those of the protocol, and those of any.
static record::TableList possible_tables(const SessionRequest& request) {
  return record::with_tables(request.protocol->tables(), record::common_tables());
}

channel::ChannelSet make_channels(const SessionRequest& request) {
  return {request.definition->channels, possible_tables(request),
          request.clock == realtime::ClockKind::kReal};
}

std::vector<std::uint64_t> next_samples(const SessionRequest& request,
                                        const channel::ChannelSet& channels) {
  if (!request.resume || !record::SessionWriter::can_resume(request.file)) {
    return {};
  }
  const record::SessionReader file(resumed_file(request));
  std::vector<std::uint64_t> next;
  for (const record::TableDescription* table : channels.tables()) {
    const std::uint64_t rows = file.has(*table) ? file.count(*table) : 0;
    const bool samples = table != &record::table_of<channel::IncidentRow>();
    if (samples) {
      next.push_back(rows == 0 ? 0
                               : static_cast<std::uint64_t>(
                                     file.integers(*table, "sample", rows - 1, 1).front()) +
                                     1);
    }
  }
  return next;
}

/// @throws InputError if a channel had other quantities when the session was recorded
static void check_same_quantities(const SessionRequest& request, const record::SessionReader& file,
                                  const channel::ChannelSet& channels) {
  const auto columns = [](const record::TableDescription& table) {
    std::vector<std::string> names;
    for (const record::Field& field : table.fields()) {
      names.emplace_back(field.column.name);
    }
    return names;
  };
  const std::vector<std::string> there = file.table_names();
  for (const record::TableDescription* table : channels.tables()) {
    const bool has = std::find(there.begin(), there.end(), table->name()) != there.end();
    if (has && columns(*file.description(table->name())) != columns(*table)) {
      throw InputError(
          fmt::format("{}: was recorded with other quantities of /{}; resume it with the same ones",
                      request.file.string() + ".partial", table->name()));
    }
  }
}

record::SessionWriter open_writer(const SessionRequest& request, const device::DeviceInfo& device,
                                  record::Resumed& before, const protocols::Trials& trials,
                                  const channel::ChannelSet& channels) {
  if (!request.resume || !record::SessionWriter::can_resume(request.file)) {
    const record::SessionInfo info = session_info(request, device);
    return record::SessionWriter(request.file, info, tables_of(request, trials, channels),
                                 trials.first_rows());
  }
  record::SessionWriter writer = record::SessionWriter::resume(
      request.file, before, record::with_tables(possible_tables(request), channels.tables()),
      tables_of(request, trials, channels));
  check_same_session(request, device, before.info);
  const record::SessionReader file(request.file.string() + ".partial");
  check_same_tutor(request, file);
  check_same_quantities(request, file, channels);
  trials.check_resumed(file);
  return writer;
}

bool repair_or_close(const SessionRequest& request) {
  const std::filesystem::path& file = request.file;
  if (!record::SessionWriter::can_resume(file)) {
    return false;
  }
  const channel::ChannelSet channels = make_channels(request);
  record::Resumed found;
  record::SessionWriter writer = record::SessionWriter::resume(
      file, found, record::with_tables(possible_tables(request), channels.tables()),
      stated_tables(request, channels));
  if (!found.repaired.empty()) {
    fmt::print(stderr, "{}\n", found.repaired);
  }
  if (found.ended) {
    writer.close();
  }
  return found.ended;
}

std::vector<DeviceChoice> choices_of(const SessionRequest& request) {
  std::vector<DeviceChoice> choices{request.device};
  choices.insert(choices.end(), request.more_devices.begin(), request.more_devices.end());
  return choices;
}

std::unique_ptr<record::LiveFigures> open_live(const SessionRequest& request) {
  const bool seen = request.clock == realtime::ClockKind::kReal || request.control != nullptr;
  return seen && request.live ? request.live(resumed_file(request)) : nullptr;
}

std::filesystem::path resumed_file(const SessionRequest& request) {
  return request.resume ? std::filesystem::path(request.file.string() + ".partial")
                        : std::filesystem::path();
}

/// Enter and the space bar.
static bool begins(const render::KeyPress& press) {
  return press.key == render::KeyPress::kEnter || press.key == render::KeyPress::kSpace;
}

/// The mark of a session that does not count, or that a program answers.
static SessionMark mark_of(const SessionRequest& request, protocols::Rig& rig) {
  const std::string pilot = request.pilot ? "PILOT " + request.subject : "";
  const std::string program = rig.subject() != nullptr ? "a program answers" : "";
  return {pilot + (pilot.empty() || program.empty() ? "" : ", ") + program, request.pilot};
}

static void move_mouse(device::MouseDevice& mouse, const ScreenPointer& pointer) {
  mouse.set_buttons(pointer.buttons);
  if (pointer.hand) {
    return mouse.reach(*pointer.hand);
  }
  mouse.turn_wheel(pointer.wheel, device::is_pressed(pointer.buttons, 0));
  mouse.move(pointer.x, pointer.z);
}

std::unique_ptr<Screen> open_screen(const SessionRequest& request, protocols::Rig& rig,
                                    ParticipantInput& input, std::function<std::int64_t()> now) {
  if (!request.window) {
    return nullptr;
  }
  // Both are called on the screen's thread.
  constexpr std::int64_t kNotedFor = 1'500'000'000;  // [ns]
  const auto noted_until = std::make_shared<std::int64_t>(0);
  const auto says_mistake = [key = request.definition->screen.mistake_key, noted_until, &input,
                             now = std::move(now)](const render::KeyPress& press) {
    const bool says = key != 0 && press.key == key;
    if (says) {
      input.mistakes.press(now());
      *noted_until = screen_ns() + kNotedFor;
    }
    return says;
  };
  const auto types = [&input](const render::KeyPress& press) {
    if (press.character != 0) {
      input.window.type(press.character);
    }
    return press.character != 0;
  };
  ScreenCallbacks callbacks;
  callbacks.words = [noted_until, &words = request.definition->texts.mistake_noted] {
    return screen_ns() < *noted_until ? words : std::string();
  };
  SessionControl* control = request.control;
  if (control != nullptr) {
    const bool steers = request.definition->screen.participant_steers;
    callbacks.key = [control, steers, &input, says_mistake, types,
                     &request](const render::KeyPress& press) {
      if (input.page_keys.take(press) || types(press) || says_mistake(press)) {
        return;
      }
      if (begins(press)) {  // heard in a break that the participant ends
        input.begin_pressed = true;
      }
      const auto asked = request_of(press);
      const bool of_trial = request.definition->bits_of({press.key}) != 0;
      const bool may = asked == Request::kEmergencyStop || steers;
      if (asked && may && !of_trial) {
        control->ask(*asked, RequestSource::kWindow);
      }
    };
    callbacks.closed = [control, steers] {
      control->ask(steers ? Request::kAbort : Request::kEmergencyStop, RequestSource::kWindow);
    };
  } else {  // nobody is there who could clear a stop or say that it goes on
    callbacks.key = [&input, says_mistake, types](const render::KeyPress& press) {
      if (input.page_keys.take(press) || types(press) || says_mistake(press)) {
        return;
      }
      if (press.key == render::KeyPress::kEscape) {
        interrupt();
      } else if (begins(press)) {
        input.begin_pressed = true;
      }
    };
    callbacks.closed = [] { interrupt(); };
  }
  if (device::Gamepad* pad = rig.gamepad()) {
    callbacks.pad = [pad] { return pad->state(); };
  }
  if (rig.mouse() != nullptr || request.definition->hears_pointer()) {
    callbacks.pointer = [&input, mouse = rig.mouse()](const ScreenPointer& pointer) {
      input.window.point({pointer.x, pointer.buttons});
      if (mouse != nullptr) {
        move_mouse(*mouse, pointer);
      }
    };
  }
  callbacks.held = [&input, &request](const std::vector<int>& keys) {
    input.window.hold(request.definition->bits_of(keys));
  };
  const protocols::Definition& setup = *request.definition;
  return std::make_unique<Screen>(setup.screen, setup.display, std::move(callbacks),
                                  mark_of(request, rig));
}

std::unique_ptr<SpeechLibrary> open_speech(const SessionRequest& request) {
  const protocols::SpeechOptions options = protocols::speech_of(*request.definition);
  if (!options.spoken || request.clock != realtime::ClockKind::kReal) {
    return nullptr;
  }
  if (!request.window) {
    throw InputError(
        "display.spoken speaks what the participant's window shows, and its keys answer; add "
        "--window");
  }
  return std::make_unique<SpeechLibrary>(options.voice);
}

std::unique_ptr<stream::LslOutlet> open_outlet(const SessionRequest& request, bool simulated,
                                               stream::SessionClock now, std::string& notice) {
  if (!request.stream) {
    return nullptr;
  }
  const stream::LslOptions options{.study = request.definition->name,
                                   .subject = request.subject,
                                   .device = request.device.name,
                                   .rate = request.definition->rate,
                                   .simulated = simulated,
                                   .sides = request.definition->side_streams()};
  return request.stream_optional ? stream::LslOutlet::open(options, std::move(now), notice)
                                 : std::make_unique<stream::LslOutlet>(options, std::move(now));
}

}  // namespace haptrial::experiments
