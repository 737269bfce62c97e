#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/record/rows/live_figures.h"
#include "core/record/rows/partner_rows.h"

namespace haptrial::experiments {

/// A page's question at the moment, for those who answer it elsewhere than in the participant's
/// window.
struct AskedItem {
  int number{0};         // counts what was asked, from 1; 0: nothing is asked
  std::string kind;      // word of its kind of question: "read", "choice", "scale"
  bool asks{true};       // false: a text that is only read
  bool consents{false};  // only with a reason may an experimenter agree
  std::string title;
  std::string text;
  std::vector<std::string> choices;  // labels
  double low{0.0}, high{0.0};        // of a number; both 0: it is none
  double step{1.0};
  std::string low_end, high_end;
  std::string hint;
  bool back{false};          // the participant may go back to the item before
  std::string given;         // the answer so far, as PageInput::give() takes it; empty: none yet
  std::string picture_file;  // as the definition names it; empty: none
  std::shared_ptr<const std::string> picture;  // its bytes, a PNG file; null: none
};

/// Source of a request, as the events of the session file name it.
enum class RequestSource : std::uint8_t { kConsole, kTerminal, kWindow };
const char* name_of(RequestSource by) noexcept;  // "console", "terminal", "window"

/// Request of an experimenter to a running session, from the console or the keyboard.
enum class Request : std::uint8_t {
  kStart,          // leave a text screen or a pause
  kPause,          // after the present pass
  kRepeatTrial,    // the present trial again, now
  kSkipTrial,      // on to the next trial
  kAbort,          // stop the session here; --resume goes on with it
  kEnd,            // the same for good: nobody goes on with it
  kEmergencyStop,  // force to zero within a tick; stays until kClear
  kClear,          // the experimenter has seen to the cause
  kTakeLead,       // of both hands, where a partner's session is linked
  kHandOver,       // gives it back
  kBack,           // to the item of a page before the present one
  kTakeBack,       // the last answer: its trial is presented again
};

/// The newest values of a channel, for the console.
struct ChannelStatus {
  struct Value {
    std::string name;
    double value{0.0};  // not finite while the instrument gives none [unit]
    std::string unit;
  };
  std::string name;
  bool live{false};           // else it is lost
  std::vector<Value> values;  // none of a stream of texts
};

/// Status of a session, sent about 20 times a second.
struct SessionStatus {
  std::string subject;
  std::string
      state;  // "instructions", "practice", "running", "paused", "break", "stopped", "ended"
  std::string screen;     // text that the participant reads; empty during a pass
  int trial{0};           // from 1
  bool practice{false};   // the trial does not count
  int trials{0};          // planned in this session
  int trials_defined{0};  // of the definition
  int block{0};           // from 1
  int blocks{0};
  std::string condition;                              // training condition of the block
  std::string phase;                                  // "training" or "test"
  std::string stage;                                  // "approach", "wait", "run", "return", "idle"
  double break_left{0.0};                             // [s]
  double target_force{0.0};                           // [N]
  double applied_force{0.0};                          // [N]
  double force_on_hand{0.0};                          // length of the commanded force [N]
  double force_limit{0.0};                            // the longest that may be commanded [N]
  Eigen::Vector3d position{Eigen::Vector3d::Zero()};  // [m]
  std::string device;
  std::string fault;  // one sentence; empty where there is none
  bool simulated{false};
  bool window{false};         // the participant has one
  bool pilot{false};          // no part of the study
  double rate{0.0};           // nominal [Hz]
  double rate_measured{0.0};  // over the last second; 0: not known yet [Hz]
  std::uint64_t ticks{0};
  std::uint64_t overruns{0};
  std::uint64_t dropped{0};
  double lateness_median_us{0.0};
  double lateness_99_us{0.0};
  double lateness_worst_us{0.0};
  int aborted_passes{0};
  bool can_take_back{false};                    // the last answer
  std::vector<std::string> aborts;              // why, the last ones
  double elapsed{0.0};                          // of the session [s]
  double left{-1.0};                            // about, until its end; below 0: not known [s]
  std::vector<std::string> notices;             // sentences that an experimenter has to know
  AskedItem asked;                              // by a page
  bool has_target{true};                        // there is a force to follow
  std::optional<record::LiveState> figures;     // of the present trial, if the study has some
  std::optional<record::PartnerState> partner;  // in a linked session
  std::vector<ChannelStatus> channels;          // those that the definition shows
};

/// The only way from a person at a console to a session: messages in, a picture of the state out.
/// Every member may be called from any thread but the servo thread.
class SessionControl {
 public:
  /// Sets the action of an emergency stop, done at once, before the session's thread takes the
  /// message.
  void on_emergency(std::function<void()> stop);

  void ask(Request request, RequestSource by = RequestSource::kConsole);
  /// @param text  kept as an event with the present trial, at most 2000 bytes; longer ones are cut
  /// @param bad_trial  the text says why the present trial, or the last one, is bad
  void note(std::string text, bool bad_trial = false);

  /// Where mirror() gets a PNG file of what the participant sees; empty: nowhere.
  void on_mirror(std::function<std::string()> picture);
  /// Any thread but the servo thread and the session's. @returns nothing without a window
  /// @throws RunError if no picture comes
  std::string mirror();

  /// An answer to what a page asks. @param number  of AskedItem  @param text  PageInput::give()
  void answer(int number, std::string text, RequestSource by = RequestSource::kConsole);

  /// Session's thread: what came since the last call, in order.
  struct Message {
    bool is_note{false};
    Request request{Request::kStart};
    std::string text;
    RequestSource by{RequestSource::kConsole};
    int answers{0};         // number of the question; 0: it is no answer
    bool bad_trial{false};  // a note that marks the trial
  };
  std::vector<Message> take();

  void publish(SessionStatus status);  // session's thread
  SessionStatus status() const;

 private:
  std::mutex stop_mutex_;  // a stop waits for nobody who reads or publishes
  std::function<void()> stop_;
  std::mutex mirror_mutex_;  // held while a picture is waited for
  std::function<std::string()> picture_;
  mutable std::mutex mutex_;
  std::vector<Message> messages_;
  SessionStatus status_;
};

}  // namespace haptrial::experiments
