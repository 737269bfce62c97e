#pragma once

#include <string>

#include "protocols/interface/drawing.h"

namespace haptrial::experiments {

/// The consequence of another text in the window.
struct SpeechChange {
  enum class Kind {
    kNone,    // what is being said goes on
    kSay,     // this, in place of the text before
    kForget,  // what has begun goes on; what waits is not said any more
    kCut,     // silence: what was asked is answered
  };
  Kind kind{Kind::kNone};
  std::string text{};  // that is said
};

/// All of a page in words: title, text, choices with their keys, scale, answer so far, hint.
/// @param seconds  the word, for a countdown
std::string words_of(const render::TextPage& page, const std::string& seconds);

/// The words to be said when one picture follows another: all of a new text; of one that was there,
/// the choice, mark or character that changed, and the hint when a key did nothing.
SpeechChange speech_between(const protocols::PictureText& before, const protocols::PictureText& now,
                            const std::string& seconds);

}  // namespace haptrial::experiments
