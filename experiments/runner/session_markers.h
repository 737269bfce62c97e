#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/record/rows/marker_row.h"
#include "core/sound/cue_player.h"
#include "core/stream/lsl_outlet.h"
#include "core/stream/marker_thread.h"
#include "core/stream/marker_times.h"
#include "core/stream/neon_events.h"
#include "experiments/runner/session_request.h"
#include "experiments/screen/screen.h"
#include "protocols/definition/speech_options.h"

namespace haptrial::experiments {

/// The markers of a session: what is sent when something begins, and the rows that say so. On the
/// real clock a thread of its own sends; a simulated session has the rows alone. Session's thread.
class SessionMarkers {
 public:
  /// Opens the serial line and the sound card.
  /// @param log     of the servo thread's onsets; outlives the markers
  /// @param outlet  null: no stream; outlives the markers
  /// @param now     the session's clock [ns], asked by several threads
  /// @throws InputError if the definition names a serial line that cannot be opened, or is spoken
  /// or has stimuli that are sounds and there is no sound card
  SessionMarkers(const SessionRequest& request, markers::OnsetLog& log, stream::LslOutlet* outlet,
                 std::function<std::int64_t()> now);
  ~SessionMarkers();
  SessionMarkers(const SessionMarkers&) = delete;
  SessionMarkers& operator=(const SessionMarkers&) = delete;

  bool used() const { return definition_.markers.used; }
  /// Notice that the experimenter has to see from the beginning: no sound card. Empty: nothing.
  const std::string& notice() const { return notice_; }
  /// The sound card; null: there is none.
  sound::CuePlayer* player() { return player_.get(); }
  /// Whether sounds are played, in a sentence; empty if the definition has none.
  std::string sound_state() const;

  /// Prepares the sounds of the coming pass that follow from its trial (Trials::varied_cues).
  void prepare(const std::vector<sound::Cue>& cues);
  /// @param row  of /trials that the pass will have
  void begin_pass(std::int32_t row, std::int32_t trial);
  /// @param take  the flashes of the screen, on the session's clock
  void watch(std::function<std::vector<Flash>()> take) { flashes_ = std::move(take); }
  /// Rows of what has been sent; waits a little, so that those of the pass that ended are there.
  /// @param last  nothing more will come: what is not there has not gone
  std::vector<record::MarkerRow> take_rows(bool last = false);

  /// Ticks whose onsets the servo thread found no room for. Any thread.
  std::uint64_t dropped() const { return log_.dropped(); }
  /// Whether the sound card is gone that gives stimuli, so that no trial may count.
  bool lost_stimuli() const;
  /// Sentences on what went wrong so far: a lost serial line, sounds that were too loud.
  std::vector<std::string> troubles() const;
  /// How soon the markers had gone, a line each way.
  std::vector<std::string> latencies() const;

 private:
  void open_outputs(const SessionRequest& request, stream::LslOutlet* outlet);
  void open_sound(const SessionRequest& request);
  void hear(const markers::TimedOnset& onset);
  bool stream(stream::LslOutlet& outlet, const markers::TimedOnset& onset) const;
  void tell_neon(const markers::TimedOnset& onset);
  void gather();
  void take_in(const markers::TimedOnset& onset);
  void give_up_waiting();
  bool all_sent() const;
  bool all_shown() const;
  record::MarkerRow row_of(const markers::TimedOnset& onset) const;
  void add(const markers::TimedOnset& onset, record::MarkerOutput way, std::int64_t written_ns,
           std::int64_t frame = -1);

  const protocols::Definition& definition_;
  const bool real_;
  const protocols::SpeechOptions speech_;
  markers::OnsetLog& log_;
  std::function<std::int64_t()> now_;
  std::vector<markers::MarkerMeaning> meanings_;
  std::vector<bool> masked_;  // by stage
  std::function<std::vector<Flash>()> flashes_;
  std::string notice_;
  std::unique_ptr<markers::SerialLine> line_;
  std::unique_ptr<sound::CuePlayer> player_;
  std::unique_ptr<markers::NeonEvents> neon_;
  bool streams_{false};

  mutable std::mutex mutex_;                     // the two that follow
  std::map<std::int32_t, std::int32_t> trials_;  // of the rows of /trials
  std::vector<markers::TimedOnset> heard_;       // by the sending thread

  std::vector<record::MarkerRow> rows_;                   // that nobody has taken
  std::vector<markers::TimedOnset> unseen_;               // that no flash has shown yet
  std::map<std::uint64_t, markers::TimedOnset> unheard_;  // whose sound has not begun, by number
  markers::MarkerLatencies latencies_;
  std::unique_ptr<markers::MarkerThread> thread_;  // last: it uses the others
};

}  // namespace haptrial::experiments
