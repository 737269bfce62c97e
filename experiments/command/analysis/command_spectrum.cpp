#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <vector>

#include "analysis/document/figure_gnuplot.h"
#include "analysis/files/csv.h"
#include "core/base/counted.h"
#include "core/base/error.h"
#include "core/base/nearest.h"
#include "core/base/scratch_folder.h"
#include "core/base/whole_file.h"
#include "core/sound/power_spectrum.h"
#include "core/sound/wav.h"
#include "experiments/command/arguments.h"
#include "experiments/command/subcommand.h"

namespace haptrial::experiments {
namespace {

struct SpectrumOptions {
  std::string file;
  std::string out;
  std::string burr{"cutting"};
  std::string level{"typical"};
  double force{0.0};
  int peaks{24};
  int segment{0};
  std::string unit;
  double full_scale{0.0};
  int channel{0};  // from 1; 0: not given
  double mass{0.0};
  bool add{false};
  std::string wav;
  std::string picture;
  bool overwrite{false};
};

namespace fs = std::filesystem;

constexpr double kSynthesized = 4.0;  // [s]
constexpr const char* kAcceleration = "m/s2";

/// A recording and its unit.
struct Measured {
  sound::Recording recording;
  std::string unit{sound::kFullScale};
};

sound::Burr burr_of(const std::string& name) {
  for (const sound::Burr burr : sound::kBurrs) {
    if (name == sound::name_of(burr)) {
      return burr;
    }
  }
  throw InputError(not_allowed("--burr", fmt::format("'{}'", name), {"diamond", "cutting"}));
}

void check(const SpectrumOptions& options) {
  const auto plain = [](unsigned char c) { return std::isalnum(c) || c == '-' || c == '_'; };
  if (options.level.empty() || !std::all_of(options.level.begin(), options.level.end(), plain)) {
    throw InputError(fmt::format(
        "--level is '{}'; allowed: letters, digits, '-', '_'; 'free' is a drill in the air",
        options.level));
  }
  if (!(options.force >= 0.0 && options.force <= 1000.0)) {
    throw InputError(fmt::format("--force is {}; allowed: 0 to 1000 [N]", options.force));
  }
  if (options.peaks < 1 || options.peaks > sound::Spectrum::kMaxPeaks) {
    throw InputError(
        fmt::format("--peaks is {}; allowed: 1 to {}", options.peaks, sound::Spectrum::kMaxPeaks));
  }
  if (!options.unit.empty() && options.unit != sound::kNewton && options.unit != kAcceleration) {
    throw InputError(
        not_allowed("--unit", fmt::format("'{}'", options.unit), {sound::kNewton, kAcceleration}));
  }
  check_new_figure(options.picture, options.overwrite);
}

/// Refuses numbers that can only be in other units, such as mN.
void check_amplitudes(const analysis::CsvTable& table, bool acceleration,
                      const std::vector<double>& values) {
  const double most = acceleration ? 1e5 : 100.0;  // [m/s2] or [N]
  for (std::size_t row = 0; row < values.size(); ++row) {
    if (std::abs(values[row]) > most) {
      table.refuse(
          row, table.column(acceleration ? "acceleration" : "force"),
          fmt::format("at most {:g} [{}]", most, acceleration ? kAcceleration : sound::kNewton));
    }
  }
}

void check_length(const sound::Recording& recording, const std::string& file) {
  constexpr std::size_t kFewest = 4096;
  if (recording.samples.size() < kFewest) {
    throw InputError(fmt::format("{}: has {} samples; allowed: at least {}", file,
                                 recording.samples.size(), kFewest));
  }
}

/// The table of a sensor: evenly in time, one of two quantities.
Measured read_table(const std::string& file) {
  constexpr double kUneven = 0.1;                     // of a step
  constexpr double kSlowest = 200.0, kFastest = 1e6;  // that can tell of a drill [Hz]
  const auto table = analysis::CsvTable::load(file);
  const bool acceleration = table.has("acceleration");
  if (acceleration == table.has("force")) {
    throw InputError(fmt::format(
        "{}: has the columns {}; allowed: time [s] and either force [N] or acceleration [m/s2]",
        file, fmt::join(table.columns(), ", ")));
  }
  const std::size_t column = table.column("time");
  const std::vector<double> times = table.numbers(column);
  const std::vector<double> values =
      table.numbers(table.column(acceleration ? "acceleration" : "force"));
  Measured measured;
  measured.unit = acceleration ? kAcceleration : sound::kNewton;
  check_amplitudes(table, acceleration, values);
  measured.recording.samples.assign(values.begin(), values.end());
  std::vector<double> steps{0.0};
  for (std::size_t i = 1; i < times.size(); ++i) {
    steps.push_back(times[i] - times[i - 1]);
  }
  std::vector<double> sorted = steps;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double step = *middle;
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (!(std::abs(steps[i] - step) < kUneven * step)) {
      table.refuse(i, column,
                   fmt::format("about {:.6g} s after the row before, as the others are", step));
    }
  }
  check_length(measured.recording, file);  // a single row has no rate
  measured.recording.rate = static_cast<double>(times.size() - 1) / (times.back() - times.front());
  if (!(measured.recording.rate >= kSlowest && measured.recording.rate <= kFastest)) {
    throw InputError(
        fmt::format("{}: has {:.4g} rows a second by its column time; allowed: {:g} to {:g}, with "
                    "times in seconds",
                    file, measured.recording.rate, kSlowest, kFastest));
  }
  return measured;
}

/// Channels may be other sensors or axes, or cancel each other, so that they are not mixed.
sound::Recording read_channel(const SpectrumOptions& options) {
  std::vector<sound::Recording> channels = sound::read_channels(options.file);
  const int count = static_cast<int>(channels.size());
  const int channel = options.channel == 0 && count == 1 ? 1 : options.channel;
  if (channel < 1 || channel > count) {
    const std::string has =
        fmt::format("{}: has {}", options.file, counted(channels.size(), "channel", "channels"));
    throw InputError(
        channel == 0 ? fmt::format("{}; add --channel, 1 to {}, that of the sensor", has, count)
                     : fmt::format("{}; --channel is {}; allowed: 1 to {}", has, channel, count));
  }
  return std::move(channels[static_cast<std::size_t>(channel - 1)]);
}

/// @throws InputError where the options do not say what the recording's numbers are
Measured read_measured(const SpectrumOptions& options) {
  if (fs::path(options.file).extension() == ".csv") {
    if (!options.unit.empty() || options.full_scale != 0.0 || options.channel != 0) {
      throw InputError(
          fmt::format("{}: is a table, whose columns say the unit; --unit, --full-scale and "
                      "--channel are for sound files",
                      options.file));
    }
    return read_table(options.file);
  }
  Measured measured{read_channel(options)};
  if (options.unit.empty() != (options.full_scale == 0.0) || options.full_scale < 0.0) {
    throw InputError(
        fmt::format("--unit is '{}' and --full-scale {}; allowed: neither, or both: "
                    "the unit of the sensor and what the file's full scale is in it",
                    options.unit, options.full_scale));
  }
  if (!options.unit.empty()) {
    measured.unit = options.unit;
    for (float& sample : measured.recording.samples) {
      sample *= static_cast<float>(options.full_scale);
    }
  }
  return measured;
}

/// Acceleration becomes the force that gives it to a mass.
void turn_into_force(const SpectrumOptions& options, Measured& measured) {
  if ((options.mass > 0.0) != (measured.unit == kAcceleration)) {
    throw InputError(
        fmt::format("--mass is {}; allowed: above 0 kg for a table made from an "
                    "acceleration, else not given",
                    options.mass));
  }
  if (options.mass > 0.0) {
    for (float& sample : measured.recording.samples) {
      sample *= static_cast<float>(options.mass);
    }
    measured.unit = sound::kNewton;
  }
}

sound::PowerSpectrum spectrum_of(const sound::Recording& recording, int segment,
                                 const std::string& file) {
  check_length(recording, file);
  try {
    return sound::power_spectrum(recording.samples, recording.rate, segment);
  } catch (const std::invalid_argument&) {
    throw InputError(fmt::format(
        "--segment is {}; allowed: a power of two from 16 to the recording's {} samples", segment,
        recording.samples.size()));
  }
}

void print_spectrum(const Measured& measured, const sound::PowerSpectrum& power,
                    const sound::Spectrum& found) {
  const sound::Recording& recording = measured.recording;
  fmt::print("recording   {:.3f} s at {:.0f} Hz\n",
             static_cast<double>(recording.samples.size()) / recording.rate, recording.rate);
  fmt::print("spectrum    {} segments, a bin every {:.4g} Hz\n", power.segments, power.bin);
  fmt::print("dominant    {:.1f} Hz; fundamental {:.1f} Hz\n", sound::dominant(found),
             sound::fundamental(found));
  fmt::print("amplitudes  {}\n", measured.unit);
  fmt::print("peaks       {:>10} {:>10} {:>10}\n", "Hz", "amplitude", "width, Hz");
  for (int i = 0; i < found.count; ++i) {
    const sound::Peak& peak = found.peaks[static_cast<std::size_t>(i)];
    fmt::print("            {:>10.1f} {:>10.5f} {:>10.1f}\n", peak.frequency, peak.amplitude,
               peak.bandwidth);
  }
  fmt::print("noise       {:.5f}\n", found.noise);
}

/// The table with the level in its place, by rising force.
sound::SpectrumTable table_with(const SpectrumOptions& options, const std::string& unit,
                                const sound::Spectrum& found) {
  sound::SpectrumTable table;
  table.unit = unit;
  table.source = fmt::format("haptrial spectrum {}", fs::path(options.file).filename().string());
  if (options.add && fs::exists(options.out)) {
    const std::string more = table.source;
    table = sound::read_spectrum_table(options.out);
    if (table.unit != unit) {
      throw InputError(fmt::format("{}: has the unit {}; allowed: {}, which that of {} is",
                                   options.out, table.unit, unit, options.file));
    }
    table.source = fmt::format("{}; {}", table.source, more);
  }
  auto& kind = table.of(burr_of(options.burr));
  const auto same = [&](const sound::Level& level) { return level.name == options.level; };
  std::erase_if(kind.free, same);
  std::erase_if(kind.contact, same);
  if (options.level == "free") {
    kind.free = {{options.level, 0.0, true, found}};
    return table;
  }
  for (const sound::Level& level : kind.contact) {
    if (level.force == options.force) {
      throw InputError(fmt::format("{}: the level '{}' is at {} N already; choose another --force",
                                   options.out, level.name, options.force));
    }
  }
  const auto above = std::find_if(kind.contact.begin(), kind.contact.end(),
                                  [&](const auto& level) { return level.force > options.force; });
  kind.contact.insert(above, {options.level, options.force, true, found});
  return table;
}

std::vector<float> synthesized(const sound::Spectrum& found, double rate, float most) {
  sound::Harmonics harmonics(rate, RandomStream(1, "spectrum"), 0.0);
  harmonics.aim(found, 1.0, 1.0);
  std::vector<float> samples(static_cast<std::size_t>(kSynthesized * rate));
  for (float& sample : samples) {
    sample = std::clamp(static_cast<float>(harmonics.next()), -most, most);
  }
  return samples;
}

analysis::Series curve(const sound::PowerSpectrum& power, const char* label,
                       const analysis::Look& look, double highest) {
  constexpr double kLeast = 1e-14;
  analysis::Series series{label, analysis::Mark::kLine, look};
  for (std::size_t i = 1; i < power.power.size(); ++i) {
    const double frequency = static_cast<double>(i) * power.bin;
    if (frequency <= highest) {
      series.x.push_back(1e-3 * frequency);
      series.y.push_back(10.0 * std::log10(std::max(kLeast, power.power[i] / power.bin)));
    }
  }
  return series;
}

/// The recording's spectrum beside that of the sound that is made from its peaks.
void draw(const SpectrumOptions& options, const std::string& unit,
          const sound::PowerSpectrum& recorded, const sound::PowerSpectrum& made) {
  constexpr double kHighest = 16'000.0;  // [Hz]
  analysis::Figure figure;
  figure.name = "spectrum";
  figure.title = fmt::format("{}", fs::path(options.file).filename().string());
  figure.x_label = "frequency [kHz]";
  figure.y_label =
      fmt::format("power density [dB re {}²/Hz]", unit == kAcceleration ? "(m/s²)" : unit);
  figure.series.push_back(
      curve(recorded, "recorded", {.color = "#1f6f8b", .width = 2.0}, kHighest));
  figure.series.push_back(
      curve(made, "from its peaks", {.color = "#c8553d", .dash = "(6,3)", .width = 1.5}, kHighest));
  figure.height = 0.45;
  const ScratchFolder folder("spectrum");
  analysis::draw_figures({figure}, folder.path());
  try {
    const fs::path drawn =
        folder.path() / ("spectrum" + fs::path(options.picture).extension().string());
    fs::copy_file(drawn, options.picture, fs::copy_options::overwrite_existing);
  } catch (const fs::filesystem_error& error) {
    throw InputError(
        fmt::format("{}: cannot be written ({}); choose a folder with write permission",
                    options.picture, error.code().message()));
  }
}

int spectrum(const SpectrumOptions& options) {
  check(options);
  burr_of(options.burr);
  Measured measured = read_measured(options);
  if (!options.out.empty() || options.mass != 0.0) {
    turn_into_force(options, measured);
  }
  if (!options.wav.empty() && measured.unit != sound::kFullScale) {
    throw InputError(
        fmt::format("--wav makes a sound, and {} is in {}", options.file, measured.unit));
  }
  const sound::Recording& recording = measured.recording;
  const sound::PowerSpectrum power = spectrum_of(recording, options.segment, options.file);
  const sound::Spectrum found = sound::find_peaks(power, {.most = options.peaks});
  print_spectrum(measured, power, found);
  if (!options.out.empty() && found.count == 0) {
    throw InputError(
        fmt::format("{}: has no line above its noise, so no table is written; record the drill "
                    "while it turns",
                    options.file));
  }
  if (!options.out.empty()) {
    const sound::SpectrumTable table = table_with(options, measured.unit, found);
    WholeFile out(options.out, options.overwrite || options.add);
    out.write(sound::to_toml(table));
    out.finish();
    fmt::print("wrote       {}\n", options.out);
  }
  if (!options.wav.empty()) {
    const std::vector<float> made = synthesized(found, recording.rate, 1.0F);
    sound::WavWriter wav(options.wav, static_cast<int>(recording.rate), options.overwrite);
    wav.write(made);
    wav.finish();
    fmt::print("wrote       {}\n", options.wav);
  }
  if (!options.picture.empty()) {
    const std::vector<float> made =
        synthesized(found, recording.rate, std::numeric_limits<float>::max());
    draw(options, measured.unit, power,
         sound::power_spectrum(made, recording.rate, options.segment));
    fmt::print("wrote       {}\n", options.picture);
  }
  return 0;
}

}  // namespace

void add_spectrum(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(
      app, "spectrum", "Make a table of a drill's sound or vibration from a recording",
      "haptrial spectrum drill.wav drill.toml --level free", {"", "algorithms/drill-sound.md"});
  auto& o = options_of<SpectrumOptions>(*sub, status, spectrum);
  sub->add_option(
         "FILE", o.file,
         "Recording: a sound file (.wav, .flac, .aiff), or a table (.csv) with the columns "
         "time [s] and force [N] or acceleration [m/s2]")
      ->required();
  sub->add_option("OUT", o.out, "New table (.toml) (default: print only)");
  sub->add_option("--burr", o.burr, with_default("Kind of burr: diamond or cutting", o.burr));
  sub->add_option("--level", o.level,
                  with_default("Name of the level; 'free' for the drill in the air", o.level));
  sub->add_option("--force", o.force, with_default("Force of the burr on the bone [N]", o.force));
  sub->add_option("--peaks", o.peaks, with_default("Largest number of peaks", o.peaks));
  sub->add_option("--segment", o.segment,
                  "Samples in a segment, a power of two (default: 40 ms or more)");
  sub->add_option("--unit", o.unit, "Unit of a sensor that recorded a sound file: N or m/s2");
  sub->add_option("--full-scale", o.full_scale, "Full scale of that file in the unit");
  sub->add_option("--channel", o.channel,
                  "Channel of a sound file that has several, from 1; they are not mixed");
  sub->add_option("--mass", o.mass,
                  "Mass of the handle, which the force of a table from an acceleration moves [kg]");
  sub->add_flag("--add", o.add, "Add the level to an existing table");
  sub->add_option("--wav", o.wav, "New sound file made from the peaks (.wav)");
  sub->add_option("--picture", o.picture, "New picture of both spectra (.png, .svg)");
  sub->add_flag("--overwrite", o.overwrite, "Overwrite existing files");
}

}  // namespace haptrial::experiments
