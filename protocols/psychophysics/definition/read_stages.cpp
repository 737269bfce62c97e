#include "protocols/psychophysics/definition/read_stages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "core/base/definition/schema.h"
#include "core/base/random.h"
#include "core/channel/channel_options.h"

namespace haptrial::protocols {
namespace {

constexpr double kLongest = 3600.0;  // [s]
constexpr Bounds kDuration{0.0, kLongest, false};
constexpr Bounds kTimeoutBounds{0.0, kLongest, true};
constexpr Bounds kSpeed{0.0, 10.0, true};

const std::vector<std::pair<std::string, Consequence>>& consequences() {
  static const std::vector<std::pair<std::string, Consequence>> words{
      {"abort", Consequence::kAbort},
      {"repeat", Consequence::kRepeat},
      {"go on", Consequence::kGoOn}};
  return words;
}

/// A stage while it is read.
struct StageReading {
  const StageSource* source{nullptr};
  NamedStage named{};
  bool waits{false};         // for more than a time
  double longest_hold{0.0};  // that `for` of until may ask [s]

  Stage& stage() { return named.stage; }
  std::string word(const std::string& text) const {
    return source->word ? source->word(text) : text;
  }
};

using Reading = StageReading;

/// @returns -1 for "null" and, with a problem noted, for what is not there
int index_of(Table& table, const std::string& key, const std::string& text, const Reading& reading,
             const std::vector<std::string>& known, const char* what) {
  const std::string name = reading.word(text);
  if (name == "null") {
    return -1;
  }
  const auto found = std::ranges::find(known, name);
  if (found == known.end()) {
    table.reject(key, fmt::format("\"{}\"", name),
                 known.empty() ? fmt::format("no {}: the definition states none", what)
                               : fmt::format("a {}: {}", what, fmt::join(known, ", ")));
    return -1;
  }
  return static_cast<int>(found - known.begin());
}

/// A bit for each name of one text or of an array of them.
std::uint64_t read_mask(Table& table, const std::string& key, const Reading& reading,
                        const std::vector<std::string>& known, const char* what) {
  const std::vector<std::string> names =
      table.is_array(key) ? table.texts(key) : std::vector{table.text(key)};
  std::uint64_t bits = 0;
  for (const std::string& name : names) {
    const int index = index_of(table, key, name, reading, known, what);
    bits |= index < 0 ? 0 : std::uint64_t{1} << static_cast<unsigned>(index);
  }
  return bits;
}

constexpr const char* kNoCondition = "no such condition";
constexpr Bounds kMeasured{-1e9, 1e9};  // in the channel's own unit

const Schema<Until>& until_schema() {
  using U = Until;
  static const auto schema =
      Schema<U>()
          .number("speed_below", &U::speed_below, kSpeed, "m/s",
                  "Speed that the hand must stay below for the stage to end")
          .otherwise(kNoCondition)
          .number("speed_above", &U::speed_above, kSpeed, "m/s",
                  "Speed that the hand must exceed for the stage to end")
          .otherwise(kNoCondition)
          .bits("buttons", &U::buttons,
                "Buttons of the device of which one must be pressed for the stage to end")
          .otherwise(kNoCondition)
          .number("above", &U::above, kMeasured, "",
                  "Value that the channel must exceed for the stage to end, in its own unit")
          .only_if([](const U& until) { return until.channel.has_value(); })
          .otherwise(kNoCondition)
          .number("below", &U::below, kMeasured, "",
                  "Value that the channel must stay below for the stage to end, in its own unit")
          .only_if([](const U& until) { return until.channel.has_value(); })
          .otherwise(kNoCondition)
          .number("time", &U::time, kDuration, "s",
                  "Time that must have passed since the stage began for it to end")
          .otherwise(kNoCondition);
  return schema;
}

/// One time, or one that is drawn from a range.
void read_hold(Table& table, const std::string& key, Reading& reading) {
  const std::vector<double> range = table.is_array(key)
                                        ? table.numbers(key, kDuration, "s")
                                        : std::vector{table.number(key, kDuration, "s")};
  reading.longest_hold = range.empty() ? 0.0 : range.back();
  double& hold = reading.stage().until.hold;
  if (range.size() == 1) {
    hold = range.front();
  } else if (range.size() != 2 || range[1] < range[0]) {
    table.reject(key, fmt::format("[{}]", fmt::join(range, ", ")),
                 "a time or [shortest, longest] [s]");
  } else {
    RandomStream* random = reading.source->random;
    hold = random != nullptr ? random->uniform(range[0], range[1]) : range[0];
  }
}

/// Keys of until whose words the definition explains, or of which trials draw a value.
const Schema<Reading>& condition_schema() {
  using R = Reading;
  static const auto schema =
      Schema<R>()
          .custom("inside",
                  "Region, or several, in all of which the hand must be for the stage to end",
                  [](Table& table, const std::string& key, R& reading) {
                    reading.stage().until.inside =
                        read_mask(table, key, reading, reading.source->regions, "region");
                  })
          .otherwise(kNoCondition)
          .custom("contact",
                  "Field, or several, all of which the hand must touch for the stage to end",
                  [](Table& table, const std::string& key, R& reading) {
                    reading.stage().until.contact =
                        read_mask(table, key, reading, reading.source->fields, "field");
                  })
          .otherwise(kNoCondition)
          .custom("keys",
                  "Keys of the participant's window of which one must be pressed for the stage to "
                  "end",
                  [](Table& table, const std::string& key, R& reading) {
                    const auto& keys = reading.source->keys;
                    reading.stage().until.keys = keys ? keys(table, key) : 0;
                  })
          .otherwise(kNoCondition)
          .custom("channel",
                  "Quantity of a channel, \"CHANNEL.QUANTITY\", or \"CHANNEL\" for its first, that "
                  "must be `above` or `below` a value for the stage to end",
                  [](Table& table, const std::string& key, R& reading) {
                    reading.stage().until.channel = channel::read_value_name(
                        table, key, reading.source->values, reading.word(table.text(key)));
                  })
          .otherwise(kNoCondition)
          .custom("for",
                  "Time for which every condition of the stage's end must hold; [shortest, "
                  "longest] is drawn in every trial",
                  read_hold)
          .otherwise("0");
  return schema;
}

void read_until(Table& table, const std::string& key, Reading& reading) {
  Table inner = table.table(key);
  Until& until = reading.stage().until;
  condition_schema().read(inner, reading);
  until_schema().read(inner, until);
  for (const char* condition :
       {"inside", "contact", "speed_below", "speed_above", "buttons", "keys", "channel"}) {
    reading.waits = inner.has(condition) || reading.waits;
  }
  if (!reading.waits && !inner.has("time")) {
    table.reject(key,
                 "names no end of the stage; state a time, a place, a contact, a speed, "
                 "buttons, keys or a channel");
  }
  if (until.channel && !inner.has("above") && !inner.has("below")) {
    inner.reject("channel", "stands without a value; add above or below");
  }
  if (until.channel && until.above >= until.below) {
    inner.reject("above", fmt::format("{:g}", until.above),
                 fmt::format("less than below, {:g}", until.below));
  }
  if (until.speed_above >= until.speed_below) {
    inner.reject("speed_above", fmt::format("{:g} [m/s]", until.speed_above),
                 fmt::format("less than speed_below, {:g} [m/s]", until.speed_below));
  }
}

const Schema<Stage>& timeout_schema() {
  static const auto schema =
      Schema<Stage>()
          .number("after", &Stage::timeout, kTimeoutBounds, "s", "Longest duration of the stage")
          .required()
          .choice("then", &Stage::late, consequences(),
                  "Consequence of a stage that takes too long: the trial is aborted and comes "
                  "again, the interval begins again, or the trial goes on")
          .required();
  return schema;
}

void read_timeout(Table& table, const std::string& key, Reading& reading) {
  Table inner = table.table(key);
  Stage& stage = reading.stage();
  timeout_schema().read(inner, stage);
  const double soonest = stage.until.time + reading.longest_hold;
  if (stage.timeout < soonest) {
    inner.reject("after", fmt::format("{:g}, before the stage can end", stage.timeout),
                 fmt::format("at least the {:g} s that until takes", soonest));
  }
}

void check_timeout(Table& table, Reading& reading) {
  if (reading.waits && !table.has("timeout")) {
    table.reject("until", "may never come; add timeout = { after = …, then = \"abort\" }");
  }
}

const char* unit_of(const Requirement& require) {
  return require.measure >= 0                          ? ""
         : require.of == Requirement::Quantity::kDepth ? "m"
         : require.of == Requirement::Quantity::kForce ? "N"
                                                       : "m/s";
}

const Schema<Requirement>& requirement_schema() {
  using R = Requirement;
  static const auto schema =
      Schema<R>()
          .choice("max_of", &R::of,
                  {{"depth", R::Quantity::kDepth},
                   {"force", R::Quantity::kForce},
                   {"speed", R::Quantity::kSpeed}},
                  "Quantity whose largest value in the stage must be enough; without [require] "
                  "nothing must")
          .otherwise("none; needed unless `measure` is stated")
          .custom("at_least", "Smallest value of the required quantity or measure that is enough",
                  [](Table& table, const std::string& key, R& require) {
                    require.at_least = table.number(
                        key, require.measure >= 0 ? kMeasured : kNonNegative, unit_of(require));
                  })
          .otherwise("needed, unless a measure has `at_most`")
          .custom("at_most", "Greatest value of the required measure that is still allowed",
                  [](Table& table, const std::string& key, R& require) {
                    require.at_most = table.number(key, kMeasured, "");
                  })
          .only_if([](const R& require) { return require.measure >= 0; })
          .otherwise("no limit")
          .choice("else", &R::otherwise, consequences(),
                  "Consequence of a stage in which the required quantity was not enough: the "
                  "trial is aborted and comes again, the interval begins again, or the trial goes "
                  "on")
          .required();
  return schema;
}

/// Reads the measure that is required, before its bounds.
void read_required_measure(Table& table, Reading& reading, Requirement& require) {
  table.describe({"measure", "Measure of this stage whose value is required", "none", false});
  if (!table.has("measure")) {
    return;
  }
  require.measure = std::max(0, index_of(table, "measure", table.text("measure"), reading,
                                         reading.source->measures, "measure"));
  require.at_least = -std::numeric_limits<double>::infinity();
}

void check_requirement(Table& table, const Requirement& require) {
  const bool measure = require.measure >= 0;
  if (measure == table.has("max_of")) {
    table.reject("max_of", measure ? "stands beside measure; keep one of the two"
                                   : "is missing; state it or measure");
  } else if (!table.has("at_least") && !(measure && table.has("at_most"))) {
    table.reject("at_least", measure ? "is missing; state it, at_most or both" : "is missing");
  } else if (require.at_least > require.at_most) {
    table.reject("at_least", fmt::format("{:g}", require.at_least),
                 fmt::format("at most at_most, {:g}", require.at_most));
  }
}

void read_requirement(Table& table, const std::string& key, Reading& reading) {
  Table inner = table.table(key);
  Requirement require;
  read_required_measure(inner, reading, require);
  requirement_schema().read(inner, require);
  check_requirement(inner, require);
  if (inner.has("max_of") && require.of != Requirement::Quantity::kSpeed) {
    inner.describe({"field", "Field whose depth or force is required", "", true});
    require.field =
        index_of(inner, "field", inner.text("field"), reading, reading.source->fields, "field");
  }
  reading.stage().require = require;
}

const Schema<Stage>& onset_schema() {
  static const auto schema =
      Schema<Stage>()
          .number("speed_above", &Stage::onset_speed, kSpeed, "m/s",
                  "Speed of the hand above which a movement has begun; without [onset] no "
                  "beginning is recorded")
          .required();
  return schema;
}

void read_sights(Table& table, const std::string& key, Reading& reading) {
  const std::vector<std::string>& sights = reading.source->sights;
  for (const std::string& text : table.texts(key)) {
    const std::string name = reading.word(text);
    if (name != "null" &&
        (sights.empty() || index_of(table, key, name, reading, sights, "sight") >= 0)) {
      reading.named.show.push_back(name);
    }
  }
}

const Schema<NamedStage>& named_stage_schema() {
  static const auto schema =
      Schema<NamedStage>()
          .text("name", &NamedStage::name, "Name of the stage, which no other stage has")
          .required()
          .integer("marker", &NamedStage::marker, 1, 255,
                   "Code of the marker at the beginning of the stage")
          .otherwise("counted on from markers.stage");
  return schema;
}

const Schema<Reading>& stage_schema() {
  using R = Reading;
  static const auto schema =
      Schema<R>()
          .keys_of(&R::named, named_stage_schema())
          .custom("fields",
                  "Fields that act in the stage; \"$name\" is the field that the name stands for",
                  [](Table& table, const std::string& key, R& reading) {
                    reading.stage().fields =
                        read_mask(table, key, reading, reading.source->fields, "field");
                  })
          .otherwise("none")
          .custom("show",
                  "Sights of the stage: hand, interval_number, regions, looks, objects and places",
                  read_sights)
          .otherwise("nothing")
          .custom("until", "Conditions that hold together at the end of the stage", read_until)
          .required()
          .custom("timeout", "Longest duration of the stage, and its consequence", read_timeout)
          .otherwise("none; needed if the stage may never end")
          .check(check_timeout)
          .custom("require", "Event without which the stage was not done as asked",
                  read_requirement)
          .otherwise("nothing")
          .custom("onset", "Beginning of a movement, whose time is recorded",
                  [](Table& table, const std::string& key, R& reading) {
                    Table onset = table.table(key);
                    onset_schema().read(onset, reading.stage());
                  })
          .otherwise("none")
          .custom("sound", "Sound that begins with the stage",
                  [](Table& table, const std::string& key, R& reading) {
                    reading.named.sound = index_of(table, key, table.text(key), reading,
                                                   reading.source->sounds, "sound");
                  })
          .otherwise("none");
  return schema;
}

NamedStage read_stage(Table& table, const StageSource& source) {
  StageReading reading{&source};
  stage_schema().read(table, reading);
  return std::move(reading.named);
}

}  // namespace

std::vector<NamedStage> read_stages(Table& root, const StageSource& source) {
  std::vector<NamedStage> stages;
  for (Table& table : root.tables("stages")) {
    NamedStage stage = read_stage(table, source);
    if (std::ranges::find(stages, stage.name, &NamedStage::name) != stages.end()) {
      table.reject("name", fmt::format("\"{}\"", stage.name), "a name that no other stage has");
    }
    stages.push_back(std::move(stage));
  }
  return stages;
}

}  // namespace haptrial::protocols
