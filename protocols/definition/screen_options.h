#pragma once

#include <cstdint>
#include <string>

#include "core/base/definition/schema_forward.h"
#include "core/questions/hint_texts.h"
#include "core/render/flat/text_screen.h"

namespace haptrial::protocols {

/// When the square for a photodiode is white; otherwise it is black.
enum class Photodiode : std::uint8_t {
  kOff,         // no square
  kEveryFrame,  // every other frame
  kRun,         // while the participant runs along the path
  kOnset,       // for a while from the frame on that follows the onset of a marker
};

/// The participant's screen.
struct ScreenOptions {
  std::string title{"haptrial"};
  bool full_screen{true};  // else a window of the size in [display]
  int monitor{0};          // from 0, the primary one
  bool refresh_lock{true};
  Photodiode photodiode{Photodiode::kOff};
  double photodiode_time{0.05};    // for which it stays white after an onset > 0 [s]
  bool participant_steers{false};  // by its keys: start, pause, repeat, skip, clear, abort
  int mistake_key{0};              // says that the last answer was a mistake; 0: none
};

/// Texts that the participant reads. The first line of a text is its title.
struct SessionTexts : questions::HintTexts {
  std::string instructions;  // before the first trial
  std::string practice;      // before the practice trials
  std::string rest;          // during a break, above the countdown
  std::string take_again{"Take the handle again\nThe break ends now."};
  std::string thanks;                                                     // at the end
  std::string counts{"Now it counts\nFrom here on every trial counts."};  // after practice
  std::string stopped{"Stopped\nThe forces are off. Please wait for the experimenter."};
  std::string paused{"A short pause\nThe session continues in a moment."};
  std::string preparing{"One moment\nWhat you are going to work on is being prepared."};
  std::string recovering{// after a pass that was aborted without a fault
                         "One moment\nThe forces are off for a few seconds. Hold the handle "
                         "loosely: it will guide your hand to the start."};
  std::string limit{
      // below the instructions
      "A square in the upper right corner shows that the device is at its force limit."};
  std::string begin{"The experimenter will start"};  // the small line below a text that waits
  std::string begin_alone{"Press Enter or the space bar to begin"};  // without an experimenter
  std::string go_back{"Press Backspace to go back"};
  std::string answered{"Thank you\nThese were all questions for now."};  // answers may be changed
  std::string declined{"Thank you\nThe session ends here."};             // who does not consent
  std::string mistake_noted{"Noted: your last answer was a mistake"};  // after the key of a mistake
};

/// The keys of [screen].
const Schema<ScreenOptions>& screen_schema();

/// The keys of [texts] that every protocol has.
const Schema<SessionTexts>& text_schema();

/// A page of a text. @param hint  how to go on; empty where nobody is asked to
render::TextPage page_of(const std::string& text, const std::string& hint = "");

}  // namespace haptrial::protocols
