#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/base/definition/definition_changes.h"
#include "core/channel/channel_set.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/recovery/session_resume.h"
#include "core/record/rows/live_figures.h"
#include "core/stream/lsl_outlet.h"
#include "experiments/runner/participant_input.h"
#include "experiments/runner/session_request.h"
#include "experiments/screen/screen.h"
#include "experiments/screen/speech_library.h"
#include "protocols/interface/trials.h"
#include "protocols/interface/window_input.h"

namespace haptrial::device {
class MouseDevice;
}

namespace haptrial::experiments {

/// Parts that a session opens before its first tick, each from the request alone.

record::SessionInfo session_info(const SessionRequest& request, const device::DeviceInfo& device);

/// Differences between the definition of a resumed session and the one that `before` has.
DefinitionChanges changes_since(const SessionRequest& request, const record::SessionInfo& before);

/// Which run leads the hand, for the session's event "tutor": file, trial, mark and the file's
/// checksum; empty: none.
std::string tutor_text(const SessionRequest& request);

/// A sentence on a session that goes on with another device than it began with; empty: it does not.
/// @param before  of the earlier runs; without a device where there are none
std::string device_change(const SessionRequest& request, const record::SessionInfo& before);

/// A new session file, or the one that is gone on with; `before` says what that one holds.
/// @throws InputError as SessionWriter does, and where the file is of another study, seed or kind,
/// or cannot be gone on with for a reason of the protocol.
record::SessionWriter open_writer(const SessionRequest& request, const device::DeviceInfo& device,
                                  record::Resumed& before, const protocols::Trials& trials,
                                  const channel::ChannelSet& channels);

/// The channels of the session, none of them open yet.
channel::ChannelSet make_channels(const SessionRequest& request);

/// Numbers from which the samples of each channel go on in a resumed file; empty for a new one.
std::vector<std::uint64_t> next_samples(const SessionRequest& request,
                                        const channel::ChannelSet& channels);

/// Repairs FILE.partial where it is damaged, as trials are made from what it holds, and gives it
/// its name where the session in it had come to its end: it was killed on the last steps.
/// @returns whether it had
/// @throws InputError, RunError as SessionWriter does
bool repair_or_close(const SessionRequest& request);

/// The choice for each device; the last one holds for those that follow.
std::vector<DeviceChoice> choices_of(const SessionRequest& request);

/// Live figures if somebody looks at them: at a console, or at the end; else null.
std::unique_ptr<record::LiveFigures> open_live(const SessionRequest& request);

/// FILE.partial, which the session goes on with; empty for a new one.
std::filesystem::path resumed_file(const SessionRequest& request);

/// The participant's screen, where one was asked for; else null. Its Escape stops the session, its
/// other keys steer it where the definition says so; its pointer moves the mouse device
/// and answers questions.
/// @param rig  outlives the screen; of devices only a mouse, or a game controller, takes the
/// pointer
/// @param input  receives what keys and pointer of the window say; outlives the screen
/// @param now    ServoLoop::elapsed_ns(); called on the screen's thread
std::unique_ptr<Screen> open_screen(const SessionRequest& request, protocols::Rig& rig,
                                    ParticipantInput& input, std::function<std::int64_t()> now);

/// The voice that speaks the texts of the window; null if they are not spoken, as in a simulated
/// session.
/// @throws InputError if the session has no window, and as SpeechLibrary does
std::unique_ptr<SpeechLibrary> open_speech(const SessionRequest& request);

/// The streams, where they were asked for; null where they were not, and, with a sentence in
/// `notice`, where they cannot be had and the session may do without them.
/// @param now  of the session
/// @throws InputError, RunError where it may not
std::unique_ptr<stream::LslOutlet> open_outlet(const SessionRequest& request, bool simulated,
                                               stream::SessionClock now, std::string& notice);

}  // namespace haptrial::experiments
