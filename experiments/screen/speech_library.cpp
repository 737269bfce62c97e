#include "experiments/screen/speech_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/base/error.h"
#include "core/base/utf8.h"
#include "core/sound/card_player.h"

namespace haptrial::experiments {
namespace {

// Values of espeak-ng's speak_lib.h.
constexpr int kSynchronous = 2;  // samples come to the callback before the call returns
constexpr int kKeepProcess = 0x8000;
constexpr int kCharacters = 1;
constexpr unsigned kUtf8 = 1;

constexpr const char* kWhere =
    "espeak-ng, which display.spoken needs; on Debian: apt install libespeak-ng1";

thread_local std::vector<short>* receiver = nullptr;  // of the synthesis that is under way

int receive(short* wave, int count, void*) {
  if (wave != nullptr && receiver != nullptr) {
    receiver->insert(receiver->end(), wave, wave + count);
  }
  return 0;
}

/// The samples at the card's rate, between neighbours along a line.
std::vector<float> at_card_rate(const std::vector<short>& wave, double rate) {
  constexpr float kFullScale = 32'768.0F;
  const double step = rate / sound::CardPlayer::kRate;
  std::vector<float> samples;
  if (wave.empty()) {
    return samples;
  }
  const auto count = static_cast<std::size_t>(static_cast<double>(wave.size() - 1) / step);
  samples.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double place = step * static_cast<double>(i);
    const auto before = static_cast<std::size_t>(place);
    const auto share = static_cast<float>(place - std::floor(place));
    const auto first = static_cast<float>(wave[before]);
    const auto second = static_cast<float>(wave[std::min(before + 1, wave.size() - 1)]);
    samples.push_back(((1.0F - share) * first + share * second) / kFullScale);
  }
  return samples;
}

/// The character if the text is a single one; else 0.
wchar_t only_character(const std::string& text) {
  if (text.empty() || character_bytes(text.front()) != text.size()) {
    return 0;
  }
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (text.size() == 1) {
    return static_cast<wchar_t>(byte(0));
  }
  std::uint32_t code = byte(0) & (0x7fU >> text.size());
  for (std::size_t i = 1; i < text.size(); ++i) {
    code = (code << 6U) | (byte(i) & 0x3fU);
  }
  return static_cast<wchar_t>(code);
}

}  // namespace

SpeechLibrary::SpeechLibrary(const std::string& voice) : library_("libespeak-ng.so.1", kWhere) {
  library_.get(initialize_, "espeak_Initialize");
  library_.get(set_callback_, "espeak_SetSynthCallback");
  library_.get(set_voice_, "espeak_SetVoiceByName");
  library_.get(synthesize_, "espeak_Synth");
  library_.get(say_character_, "espeak_Char");
  library_.get(terminate_, "espeak_Terminate");
  const int rate = initialize_(kSynchronous, 0, nullptr, kKeepProcess);
  if (rate <= 0) {
    throw InputError(
        "espeak-ng, which display.spoken needs, has no data; on Debian: apt install "
        "espeak-ng-data");
  }
  rate_ = rate;
  set_callback_(receive);
  if (set_voice_(voice.c_str()) != 0) {
    terminate_();
    throw InputError(fmt::format(
        "espeak-ng has no voice \"{}\", by which display.spoken would speak (display.voice, or the "
        "language of the texts); `espeak-ng --voices` lists those that it has",
        voice));
  }
}

SpeechLibrary::~SpeechLibrary() { terminate_(); }

std::vector<float> SpeechLibrary::samples(const std::string& text) {
  std::vector<short> wave;
  receiver = &wave;
  if (const wchar_t character = only_character(text); character != 0) {
    say_character_(character);
  } else if (!text.empty()) {
    synthesize_(text.c_str(), text.size() + 1, 0, kCharacters, 0, kUtf8, nullptr, nullptr);
  }
  receiver = nullptr;
  return at_card_rate(wave, rate_);
}

}  // namespace haptrial::experiments
