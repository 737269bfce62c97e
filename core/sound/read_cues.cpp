#include "core/sound/read_cues.h"

#include "core/base/definition/table.h"

namespace haptrial::sound {
namespace {

constexpr const char* kMasking = "masking";
constexpr const char* kDevice = "device";
constexpr Bounds kHeard{20.0, 20'000.0, false};  // [Hz]
constexpr Bounds kLength{0.0, 60.0, true};       // [s]
constexpr Bounds kLevel{-120.0, -3.1, false};    // a sine that just fits has -3.01 dB

NoiseColour read_colour(Table& table, NoiseColour colour) {
  if (table.has("colour")) {
    const std::string word = table.choice("colour", {"white", "pink", "band"});
    colour.kind = word == "pink"   ? NoiseColour::Kind::kPink
                  : word == "band" ? NoiseColour::Kind::kBand
                                   : NoiseColour::Kind::kWhite;
  }
  const bool band = colour.kind == NoiseColour::Kind::kBand;
  if (band || table.has("low")) {
    colour.low = table.number("low", kHeard, "Hz");
  }
  if (band || table.has("high")) {
    colour.high = table.number("high", kHeard, "Hz");
  }
  if (!(colour.high > colour.low)) {
    table.reject("high", "must be above low; change one of them");
    colour = {colour.kind};
  }
  return colour;
}

Cue read_cue(Table& table, const std::string& name) {
  Cue cue;
  cue.name = name;
  const std::string type = table.choice("type", {"tone", "noise", "click", "file"});
  if (type == "file") {
    cue.kind = Cue::Kind::kFile;
    cue.file = table.text("file");
    cue.level = table.has("level") ? table.number("level", {-120.0, 0.0}, "dB") : 0.0;
    return cue;
  }
  cue.level = table.number("level", kLevel, "dB");
  if (type == "click") {
    cue.kind = Cue::Kind::kClick;
    cue.duration = table.has("duration") ? table.number("duration", kLength, "s") : 0.001;
    return cue;
  }
  cue.duration = table.number("duration", kLength, "s");
  cue.rise = table.has("rise") ? table.number("rise", kNonNegative, "s") : cue.rise;
  if (2.0 * cue.rise > cue.duration) {
    table.reject(table.has("rise") ? "rise" : "duration",
                 "leaves nothing between the ramps; rise must be at most half the duration");
  }
  if (type == "tone") {
    cue.frequency = table.number("frequency", kHeard, "Hz");
  } else {
    cue.kind = Cue::Kind::kNoise;
    cue.colour = read_colour(table, cue.colour);
  }
  return cue;
}

Masking read_masking(Table& table) {
  Masking masking;
  masking.colour = read_colour(table, masking.colour);
  masking.level = table.number("level", kLevel, "dB");
  masking.fade = table.has("fade") ? table.number("fade", {0.0, 60.0}, "s") : masking.fade;
  if (table.has("stages")) {
    masking.stages = table.texts("stages");
  }
  return masking;
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

CueSet read_cues(Table& table) {
  CueSet set;
  if (table.has(kDevice)) {
    set.device = table.text(kDevice);
  }
  for (const std::string& name : cue_names(table)) {
    Table cue = table.table(name);
    set.cues.push_back(read_cue(cue, name));
  }
  if (table.has(kMasking)) {
    Table masking = table.table(kMasking);
    set.masking = read_masking(masking);
  }
  return set;
}

}  // namespace haptrial::sound
