#pragma once

#include <algorithm>
#include <initializer_list>
#include <vector>

#include "core/sound/harmonics.h"

namespace haptrial::sound {

inline Spectrum lines(std::initializer_list<Peak> peaks, double noise = 0.0) {
  Spectrum spectrum;
  for (const Peak& peak : peaks) {
    spectrum.peaks[static_cast<std::size_t>(spectrum.count++)] = peak;
  }
  spectrum.noise = noise;
  return spectrum;
}

inline std::vector<float> drawn(Harmonics& harmonics, double rate, double seconds) {
  std::vector<float> samples(static_cast<std::size_t>(rate * seconds));
  std::generate(samples.begin(), samples.end(),
                [&] { return static_cast<float>(harmonics.next()); });
  return samples;
}

}  // namespace haptrial::sound
