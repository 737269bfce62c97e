#include "core/sound/read_cues.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/base/definition/schema.h"

namespace haptrial::sound {
namespace {

constexpr const char* kMasking = "masking";
constexpr const char* kDevice = "device";
constexpr Bounds kHeard{20.0, 20'000.0, false};  // [Hz]
constexpr Bounds kLength{0.0, 60.0, true};       // [s]
constexpr double kPeaksOfNoise = 5.0;            // root mean squares, seldom exceeded
constexpr Bounds kLevel{-120.0, -3.1, false};    // a sine that just fits has -3.01 dB

bool is_file(const Cue& cue) { return cue.kind == Cue::Kind::kFile; }
bool is_felt(const Cue& cue) { return !cue.actuator.empty(); }
bool has_level(const Cue& cue) { return !is_file(cue) && !is_felt(cue); }
bool has_gain(const Cue& cue) { return is_file(cue) && !is_felt(cue); }
bool is_click(const Cue& cue) { return cue.kind == Cue::Kind::kClick; }
bool is_tone(const Cue& cue) { return cue.kind == Cue::Kind::kTone; }
bool is_noise(const Cue& cue) { return cue.kind == Cue::Kind::kNoise; }
bool has_ramps(const Cue& cue) { return is_tone(cue) || is_noise(cue); }

/// A band needs both of its ends, and every noise some width.
void check_ends(Table& table, NoiseColour& colour) {
  for (const char* key : {"low", "high"}) {
    if (colour.kind == NoiseColour::Kind::kBand && !table.has(key)) {
      table.number(key, kHeard, "Hz");  // notes that it is missing
    }
  }
  if (!(colour.high > colour.low)) {
    table.reject("high", "must be above low; change one of them");
    colour = {colour.kind};
  }
}

const Schema<NoiseColour>& colour_schema() {
  using C = NoiseColour;
  static const auto schema =
      Schema<C>()
          .choice("colour", &C::kind,
                  {{"white", C::Kind::kWhite}, {"pink", C::Kind::kPink}, {"band", C::Kind::kBand}},
                  "Spectrum of a noise: equal power in every hertz, in every octave, or between "
                  "two frequencies alone")
          .number("low", &C::low, kHeard, "Hz", "Lowest frequency of a noise")
          .otherwise("20, of a band needed")
          .number("high", &C::high, kHeard, "Hz", "Highest frequency of a noise")
          .otherwise("20000, of a band needed")
          .check(check_ends);
  return schema;
}

void set_defaults_of_kind(Cue& cue) {
  cue.level = is_file(cue) ? 0.0 : cue.level;
  cue.duration = is_click(cue) ? 0.001 : cue.duration;
}

void check_ramps(Table& table, Cue& cue) {
  if (has_ramps(cue) && 2.0 * cue.rise > cue.duration) {
    table.reject(table.has("rise") ? "rise" : "duration",
                 "leaves nothing between the ramps; rise must be at most half the duration");
  }
}

constexpr const char* kLevelText =
    "Root mean square of a sound, below full scale; gain of a recording";
constexpr const char* kLevelAbsent = "0 of a file, else needed";
constexpr const char* kDurationText = "Duration of a sound";
constexpr const char* kDurationAbsent = "0.001 of a click, else needed";

const Schema<Cue>& cue_schema() {
  using C = Cue;
  static const auto schema =
      Schema<C>()
          .choice("type", &C::kind,
                  {{"tone", C::Kind::kTone},
                   {"noise", C::Kind::kNoise},
                   {"click", C::Kind::kClick},
                   {"file", C::Kind::kFile}},
                  "Kind of a sound: a sine, a burst of noise, a pulse or a recording")
          .required()
          .derive(set_defaults_of_kind)
          .text("actuator", &C::actuator,
                "Name of the actuator that gives the sound as a vibration")
          .otherwise("loudspeakers play it")
          .number("amplitude", &C::amplitude, {0.0, 1e6, true}, "",
                  "Amplitude of a vibration in the actuator's unit: the peak, of noise the root "
                  "mean square, of a recording what its full scale becomes")
          .required()
          .only_if(is_felt)
          .custom("file", "Recording at 48,000 samples a second (WAV), relative to the definition",
                  [](Table& table, const std::string& key, C& cue) { cue.file = table.text(key); })
          .required()
          .only_if(is_file)
          .number("level", &C::level, {-120.0, 0.0}, "dB", kLevelText)
          .otherwise(kLevelAbsent)
          .only_if(has_gain)
          .number("level", &C::level, kLevel, "dB", kLevelText)
          .required()
          .otherwise(kLevelAbsent)
          .only_if(has_level)
          .number("duration", &C::duration, kLength, "s", kDurationText)
          .otherwise(kDurationAbsent)
          .only_if(is_click)
          .number("duration", &C::duration, kLength, "s", kDurationText)
          .required()
          .otherwise(kDurationAbsent)
          .only_if(has_ramps)
          .number("rise", &C::rise, kNonNegative, "s",
                  "Duration of the ramps at both ends of a tone or noise, against clicks")
          .only_if(has_ramps)
          .check(check_ramps)
          .number("frequency", &C::frequency, kHeard, "Hz", "Frequency of a tone")
          .required()
          .only_if(is_tone)
          .keys_of(&C::colour, colour_schema())
          .only_if(is_noise);
  return schema;
}

const Schema<Masking>& masking_schema() {
  using M = Masking;
  static const auto schema =
      Schema<M>()
          .keys_of(&M::colour, colour_schema())
          .number("level", &M::level, kLevel, "dB",
                  "Root mean square of the masking noise, below full scale")
          .required()
          .number("fade", &M::fade, {0.0, 60.0}, "s",
                  "Time over which the masking noise grows at its beginning and falls at its end")
          .texts("stages", &M::stages, "Names of the stages in which the masking noise sounds")
          .otherwise("the whole session");
  return schema;
}

const Schema<CueSet>& device_schema() {
  static const auto schema = Schema<CueSet>().text(
      kDevice, &CueSet::device, "Sound card that plays the sounds, by its name in ALSA");
  return schema;
}

}  // namespace

/// Takes the level of a vibration from its amplitude. What the actuator cannot give is noted.
void fit_to_actuator(Table& table, const std::vector<Actuator>& actuators, Cue& cue) {
  if (!is_felt(cue)) {
    return;
  }
  const auto actuator = std::ranges::find(actuators, cue.actuator, &Actuator::name);
  if (actuator == actuators.end()) {
    table.reject("actuator", fmt::format("\"{}\"", cue.actuator), "a name of [actuators]");
    return;
  }
  const double share = cue.amplitude / actuator->full_scale;
  const double most = actuator->full_scale / (is_noise(cue) ? kPeaksOfNoise : 1.0);
  if (cue.amplitude > most) {
    table.reject("amplitude", fmt::format("{:g}", cue.amplitude),
                 fmt::format("at most {:g} [{}], which is what {} gives", most, actuator->unit,
                             actuator->name));
  }
  if (is_noise(cue) && (cue.colour.low < actuator->lowest || cue.colour.high > actuator->highest)) {
    table.reject("colour", fmt::format("of {:g} to {:g} Hz", cue.colour.low, cue.colour.high),
                 fmt::format("\"band\" with low and high from {:g} to {:g} [Hz], for which {} is "
                             "calibrated",
                             actuator->lowest, actuator->highest, actuator->name));
  }
  if (is_tone(cue) && !(cue.frequency >= actuator->lowest && cue.frequency <= actuator->highest)) {
    table.reject("frequency", fmt::format("{:g}", cue.frequency),
                 fmt::format("{:g} to {:g} [Hz], for which {} is calibrated", actuator->lowest,
                             actuator->highest, actuator->name));
  }
  cue.level = 20.0 * std::log10(is_tone(cue) ? share / std::numbers::sqrt2 : share);
}

namespace {

bool has_formula(const Table& table) {
  return std::ranges::any_of(
      std::array{"amplitude", "frequency", "level", "duration", "rise", "low", "high"},
      [&](const char* key) { return table.has_text(key); });
}

Cue read_cue(Table& table, const std::string& name, const std::vector<Actuator>& actuators) {
  Cue cue = cue_schema().read(table);
  cue.name = name;
  fit_to_actuator(table, actuators, cue);
  return cue;
}

/// A sound that varies, of which only the file is known and can be checked.
Cue varied_cue(Table& table, const std::string& name) {
  Cue cue;
  cue.name = name;
  cue.actuator = table.whole_text("actuator").value_or("");
  cue.varies = true;
  if (const auto file = table.whole_text("file")) {
    cue.kind = Cue::Kind::kFile;
    cue.level = 0.0;
    cue.file = *file;
  }
  return cue;
}

}  // namespace

std::vector<std::string> cue_names(const Table& table) {
  std::vector<std::string> names;
  for (const std::string& name : table.keys_as_written()) {
    if (name != kDevice && name != kMasking) {
      names.push_back(name);
    }
  }
  return names;
}

CueSet read_cues(Table& table, std::vector<Actuator> actuators) {
  CueSet set = device_schema().read(table);
  set.actuators = std::move(actuators);
  for (const std::string& name : cue_names(table)) {
    Table inner = table.table(name);
    set.cues.push_back(has_formula(inner) ? varied_cue(inner, name)
                                          : read_cue(inner, name, set.actuators));
  }
  if (table.has(kMasking)) {
    Table masking = table.table(kMasking);
    set.masking = masking_schema().read(masking);
  }
  return set;
}

std::vector<Cue> read_varied_cues(Table& table, const CueSet& set) {
  std::vector<Cue> cues;
  for (const Cue& known : set.cues) {
    if (known.varies) {
      Table inner = table.table(known.name);
      cues.push_back(read_cue(inner, known.name, set.actuators));
      cues.back().file = known.file;
    }
  }
  return cues;
}

}  // namespace haptrial::sound
