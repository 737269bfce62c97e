#include "experiments/session_opening.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <utility>

#include "core/base/error.h"
#include "core/device/mouse.h"
#include "core/record/session_reader.h"
#include "experiments/bone_record.h"
#include "experiments/interrupt.h"
#include "experiments/version.h"

namespace haptrial::experiments {

DefinitionChanges changes_since(const SessionRequest& request, const record::SessionInfo& before) {
  const bool virtual_hand = before.device == "virtual" || request.device.name == "virtual";
  return definition_changes(before.definition, setup_of(request).text,
                            virtual_hand ? Hand::kVirtual : Hand::kPerson);
}

namespace {

/// What a resumed session must have in common with the one that is gone on with.
void check_same_session(const SessionRequest& request, const record::SessionInfo& before) {
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
}

/// A bone's file beside the definition may have changed since: what follows would be of another.
void check_bones(const std::filesystem::path& file, const std::vector<record::BoneRecord>& bones) {
  const std::filesystem::path partial = file.string() + ".partial";
  const std::vector<record::BoneRecord> before = record::SessionReader(partial).bones();
  for (std::size_t i = 0; i < std::max(before.size(), bones.size()); ++i) {
    if (i >= before.size() || i >= bones.size() || !same_bone(before[i], bones[i])) {
      throw InputError(
          fmt::format("{}: was recorded with another bone {} ('{}'); resume it with "
                      "the same ones",
                      partial.string(), i + 1, i < before.size() ? before[i].bone.name : "none"));
    }
  }
}

}  // namespace

record::SessionInfo session_info(const SessionRequest& request, const device::DeviceInfo& device) {
  const Setup& d = setup_of(request);
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
  info.participant = request.person;
  return info;
}

record::SessionWriter open_writer(const SessionRequest& request, const device::DeviceInfo& device,
                                  record::Resumed& before,
                                  const std::optional<std::vector<record::BoneRecord>>& bones) {
  if (!request.resume || !record::SessionWriter::can_resume(request.file)) {
    const record::SessionInfo info = session_info(request, device);
    return bones ? record::SessionWriter(request.file, info, *bones)
                 : record::SessionWriter(request.file, info);
  }
  record::SessionWriter writer = record::SessionWriter::resume(request.file, before);
  check_same_session(request, before.info);
  if (bones) {
    check_bones(request.file, *bones);
  }
  return writer;
}

bool close_what_had_ended(const std::filesystem::path& file) {
  if (!record::SessionWriter::can_resume(file)) {
    return false;
  }
  try {
    const auto runs = record::SessionReader(file.string() + ".partial").runs();
    if (runs.empty() || runs.back().state != record::RunState::kEnded) {
      return false;
    }
  } catch (const InputError&) {
    // It is damaged: a resume repairs it, and says what it holds.
  }
  record::Resumed found;
  record::SessionWriter writer = record::SessionWriter::resume(file, found);
  if (found.ended) {
    writer.close();
  }
  return found.ended;
}

namespace {

/// Whether a key is for the bone and not for the session.
bool is_of_drilling(const SessionRequest& request, int key) {
  return request.bone != nullptr &&
         protocols::functions_of_keys(request.bone->drilling.controls, {key}) != 0;
}

}  // namespace

std::unique_ptr<Screen> open_screen(const SessionRequest& request, device::MouseDevice* mouse,
                                    std::atomic<std::uint32_t>* held, std::atomic<bool>* begin) {
  if (!request.window) {
    return nullptr;
  }
  ScreenCallbacks callbacks;
  SessionControl* control = request.control;
  if (control != nullptr) {
    const bool steers = setup_of(request).screen.participant_steers;
    callbacks.key = [control, steers, &request](const render::KeyPress& press) {
      const auto asked = request_of(press);
      const bool may = asked == Request::kEmergencyStop || steers;
      if (asked && may && !is_of_drilling(request, press.key)) {
        control->ask(*asked, Asker::kWindow);
      }
    };
    callbacks.closed = [control, steers] {
      control->ask(steers ? Request::kAbort : Request::kEmergencyStop, Asker::kWindow);
    };
  } else {  // nobody is there who could clear a stop or say that it goes on
    callbacks.key = [begin](const render::KeyPress& press) {
      if (press.key == render::KeyPress::kEscape) {
        interrupt();
      } else if (press.key == render::KeyPress::kEnter || press.key == render::KeyPress::kSpace) {
        begin->store(true);
      }
    };
    callbacks.closed = [] { interrupt(); };
  }
  if (mouse != nullptr) {
    callbacks.pointer = [mouse](const ScreenPointer& pointer) {
      mouse->move(pointer.x, pointer.z);
      mouse->set_buttons(pointer.buttons);
      mouse->press(device::is_pressed(pointer.buttons, 0) ? mouse->press_at(pointer.wheel) : 0.0);
    };
  }
  if (request.bone != nullptr) {
    callbacks.held = [held, &request](const std::vector<int>& keys) {
      held->store(protocols::functions_of_keys(request.bone->drilling.controls, keys),
                  std::memory_order_relaxed);
    };
  }
  const Setup& setup = setup_of(request);
  return std::make_unique<Screen>(setup.screen, setup.display, std::move(callbacks));
}

std::unique_ptr<stream::LslOutlet> open_outlet(const SessionRequest& request, bool simulated,
                                               stream::SessionClock now, std::string& notice) {
  if (!request.stream) {
    return nullptr;
  }
  const stream::LslOptions options{.study = setup_of(request).name,
                                   .subject = request.subject,
                                   .device = request.device.name,
                                   .rate = setup_of(request).rate,
                                   .simulated = simulated};
  return request.stream_optional ? stream::LslOutlet::open(options, std::move(now), notice)
                                 : std::make_unique<stream::LslOutlet>(options, std::move(now));
}

std::vector<record::StimulusRow> stimulus_rows(const stimulus::Stimulus& s, std::int32_t block,
                                               double rate) {
  std::vector<record::StimulusRow> rows;
  const double end = s.path.duration();
  const auto add = [&](double t) {
    rows.push_back({block, t, s.path.at(t).position, s.force.at(t)});
  };
  const auto steps = static_cast<std::size_t>(end * rate);
  rows.reserve(steps + 2);
  for (std::size_t i = 0; i <= steps; ++i) {
    add(static_cast<double>(i) / rate);
  }
  constexpr double kRounding = 1e-9;  // [s]
  if (end - rows.back().time > kRounding) {
    add(end);
  }
  return rows;
}

}  // namespace haptrial::experiments
