#pragma once

#include <string>

#include "core/base/definition/schema_forward.h"

namespace haptrial::protocols {

struct Definition;

/// Speech of what the participant's window shows.
struct SpeechOptions {
  bool spoken{false};
  std::string voice{"en"};         // of espeak-ng
  std::string seconds{"seconds"};  // the word, in the voice's language
  std::string card{"default"};     // ALSA's name of the sound card
};

/// The keys of [display].
const Schema<SpeechOptions>& speech_schema();

/// The speech that a definition asks for, in the language of its texts.
SpeechOptions speech_of(const Definition& definition);

}  // namespace haptrial::protocols
