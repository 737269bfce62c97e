#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/base/dynamic_library.h"

namespace haptrial::experiments {

/// espeak-ng, which makes speech of texts; its library is loaded at run time. The library has one
/// state in a process: one object at a time, used by one thread at a time.
class SpeechLibrary {
 public:
  /// @param voice  a name or language of espeak-ng: "en", "de"
  /// @throws InputError if the library or its data is absent, or has no such voice
  explicit SpeechLibrary(const std::string& voice);
  ~SpeechLibrary();
  SpeechLibrary(const SpeechLibrary&) = delete;
  SpeechLibrary& operator=(const SpeechLibrary&) = delete;

  /// The text as samples at sound::CardPlayer::kRate, within full scale; a single character by its
  /// name. Empty if there is nothing to say.
  std::vector<float> samples(const std::string& text);

 private:
  using Callback = int (*)(short* wave, int count, void* events);

  DynamicLibrary library_;
  int (*initialize_)(int output, int buffer, const char* path, int options){nullptr};
  void (*set_callback_)(Callback){nullptr};
  int (*set_voice_)(const char* name){nullptr};
  int (*synthesize_)(const void* text, std::size_t size, unsigned position, int position_type,
                     unsigned end, unsigned flags, unsigned* identifier, void* data){nullptr};
  int (*say_character_)(wchar_t character){nullptr};
  int (*terminate_)(){nullptr};
  double rate_{22'050.0};  // of the library's samples [Hz]
};

}  // namespace haptrial::experiments
