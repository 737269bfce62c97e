// A stand-in for libespeak-ng: the same C functions, which write each text that is to be said as a
// line of the file that STAND_IN_SPEECH_FILE names, and give a short tone. Voices: "en" and "de".

#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>

namespace {

using Callback = int (*)(short* wave, int count, void* events);

constexpr int kRate = 22'050;
Callback callback = nullptr;
std::string voice = "none";

void say(const std::string& text) {
  if (const char* file = std::getenv("STAND_IN_SPEECH_FILE")) {
    std::ofstream(file, std::ios::app) << voice << "\t" << text << std::endl;
  }
  constexpr double kFrequency = 440.0;  // [Hz]
  std::array<short, kRate / 20> wave{};
  for (std::size_t i = 0; i < wave.size(); ++i) {
    wave[i] = static_cast<short>(8000.0 *
                                 std::sin(6.283185 * kFrequency * static_cast<double>(i) / kRate));
  }
  callback(wave.data(), static_cast<int>(wave.size()), nullptr);
  callback(nullptr, 0, nullptr);
}

}  // namespace

extern "C" {

int espeak_Initialize(int, int, const char*, int) { return kRate; }
void espeak_SetSynthCallback(Callback to) { callback = to; }
int espeak_SetVoiceByName(const char* name) {
  const bool known = std::strcmp(name, "en") == 0 || std::strcmp(name, "de") == 0;
  voice = known ? name : voice;
  return known ? 0 : 2;
}
int espeak_Synth(const void* text, std::size_t, unsigned, int, unsigned, unsigned, unsigned*,
                 void*) {
  say(static_cast<const char*>(text));
  return 0;
}
int espeak_Char(wchar_t character) {
  say(std::string(1, static_cast<char>(character)));
  return 0;
}
int espeak_Terminate() { return 0; }

}  // extern "C"
