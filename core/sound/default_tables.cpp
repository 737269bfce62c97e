#include <fmt/format.h>

#include "core/sound/spectrum_table.h"

namespace haptrial::sound {
namespace {

/// Peaks that `haptrial spectrum` found in a recording of a drill that runs, whose burr and load
/// are not known (docs/algorithms/drill-sound.md).
constexpr std::array kRecorded{Peak{406.9, 0.00113, 8.1},   Peak{817.2, 0.00264, 23.7},
                               Peak{2264.3, 0.03169, 36.0}, Peak{3395.0, 0.00915, 60.1},
                               Peak{4536.5, 0.00654, 66.6}, Peak{5642.5, 0.00832, 65.6},
                               Peak{9073.7, 0.00557, 20.7}, Peak{12538.9, 0.00287, 20.7}};
constexpr double kRecordedNoise = 0.0336;

Spectrum recorded() {
  Spectrum spectrum;
  for (const Peak& peak : kRecorded) {
    spectrum.peaks[static_cast<std::size_t>(spectrum.count++)] = peak;
  }
  spectrum.noise = kRecordedNoise;
  return spectrum;
}

/// The same lines, made up: a load slows the drill and makes it louder and rougher.
Spectrum varied(Spectrum spectrum, double pitch, double loudness, double roughness) {
  for (Peak& peak : spectrum.peaks) {
    peak = {pitch * peak.frequency, loudness * peak.amplitude, roughness * peak.bandwidth};
  }
  spectrum.noise *= loudness * roughness;
  return spectrum;
}

/// Lines of a vibration that a handle at 1 kHz can give: the drill's own turning, at above 1 kHz,
/// is not among them. All made up.
Spectrum rumble(double pitch, double amplitude) {
  Spectrum spectrum;
  spectrum.count = 3;
  spectrum.peaks[0] = {95.0 * pitch, amplitude, 6.0};
  spectrum.peaks[1] = {190.0 * pitch, 0.6 * amplitude, 10.0};
  spectrum.peaks[2] = {310.0 * pitch, 0.4 * amplitude, 14.0};
  spectrum.noise = 0.15 * amplitude;
  return spectrum;
}

}  // namespace

SpectrumTable default_sound() {
  SpectrumTable table;
  table.source =
      "cutting.free: a recorded drill loop, its burr and load unknown; all else made up from it";
  table.unit = kFullScale;
  const Spectrum loop = recorded();
  table.of(Burr::kCutting) = {{{"free", 0.0, true, loop}},
                              {{"light", 0.0, false, varied(loop, 0.97, 1.5, 1.3)},
                               {"typical", 2.0, false, varied(loop, 0.88, 2.6, 1.8)}}};
  table.of(Burr::kDiamond) = {{{"free", 0.0, false, varied(loop, 1.03, 0.9, 0.8)}},
                              {{"light", 0.0, false, varied(loop, 1.01, 1.1, 0.9)},
                               {"typical", 2.0, false, varied(loop, 0.95, 1.6, 1.1)}}};
  return table;
}

SpectrumTable default_vibration() {
  SpectrumTable table;
  table.source = fmt::format("made up: the source prints its recordings without numbers");
  table.unit = kNewton;
  table.of(Burr::kCutting) = {
      {{"free", 0.0, false, rumble(1.0, 0.02)}},
      {{"light", 0.0, false, rumble(0.97, 0.08)}, {"typical", 2.0, false, rumble(0.85, 0.25)}}};
  table.of(Burr::kDiamond) = {
      {{"free", 0.0, false, rumble(1.1, 0.015)}},
      {{"light", 0.0, false, rumble(1.08, 0.03)}, {"typical", 2.0, false, rumble(1.0, 0.09)}}};
  return table;
}

}  // namespace haptrial::sound
