#include "protocols/psychophysics/definition/measure.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/definition/schema.h"
#include "core/channel/channel_options.h"
#include "core/device/handle_part.h"
#include "protocols/psychophysics/definition/trial_devices.h"

namespace haptrial::protocols {
namespace {

/// A measure while it is read.
struct MeasureReading {
  const MeasureSource* source{nullptr};
  Measure measure{};
  bool own_device{false};  // stated
};

/// The index of a name; 0, with a problem noted, if it is not known.
std::size_t index_among(Table& table, const std::string& key,
                        const std::vector<std::string>& known) {
  const std::string name = table.text(key);
  const auto found = std::ranges::find(known, name);
  if (found == known.end()) {
    table.reject(key, fmt::format("\"{}\"", name),
                 known.empty() ? std::string("none: the definition has no such name")
                               : fmt::format("one of: {}", fmt::join(known, ", ")));
    return 0;
  }
  return static_cast<std::size_t>(found - known.begin());
}

void read_measured_stage(Table& table, const std::string& key, MeasureReading& r) {
  r.measure.stage = index_among(table, key, r.source->stages);
}

void read_measured_interval(Table& table, const std::string& key, MeasureReading& r) {
  r.measure.interval = static_cast<int>(index_among(table, key, r.source->intervals));
}

void read_measured_device(Table& table, const std::string& key, MeasureReading& r) {
  std::vector<std::string> names;
  std::ranges::transform(r.source->devices, std::back_inserter(names), &TrialDevice::name);
  r.measure.device = index_among(table, key, names);
  r.own_device = true;
}

/// A field is felt by the first device on which it acts, unless another one is named.
void read_measured_field(Table& table, const std::string& key, MeasureReading& r) {
  r.measure.field = static_cast<int>(index_among(table, key, r.source->fields));
  const std::vector<std::uint64_t>& felt = r.source->felt;
  for (std::size_t device = felt.size(); !r.own_device && device-- > 0;) {
    r.measure.device = (felt[device] >> r.measure.field & 1U) != 0 ? device : r.measure.device;
  }
}

void read_measured_channel(Table& table, const std::string& key, MeasureReading& r) {
  r.measure.channel = channel::read_value_name(table, key, r.source->values, table.text(key));
}

void read_measured_aim(Table& table, const std::string& key, MeasureReading& r) {
  const std::string name = table.text(key);
  const auto target = std::ranges::find(r.source->targets, name);
  if (target != r.source->targets.end()) {
    r.measure.target = static_cast<int>(target - r.source->targets.begin());
  } else if (const auto place = r.source->place(name)) {
    r.measure.place = *place;
  } else {
    table.reject(key, fmt::format("\"{}\"", name), "the name of a place or of a moving target");
  }
}

/// Numbers or formulas, lowest and highest.
void read_right_values(Table& table, const std::string& key, MeasureReading& r) {
  constexpr const char* kAllowed = "[lowest, highest], numbers or formulas";
  std::vector<double> range;
  const auto rows = table.rows(key, kAllowed);
  for (std::size_t i = 0; rows.size() == 1 && i < rows[0].size(); ++i) {
    const NumberOrText& each = rows[0][i];
    range.push_back(each.number ? *each.number : table.worth(key, each.text, {}, "").value_or(0.0));
  }
  if (range.size() != 2 || range[1] < range[0]) {
    table.reject(key, fmt::format("[{}]", fmt::join(range, ", ")), kAllowed);
    return;
  }
  r.measure.low = range[0];
  r.measure.high = range[1];
  r.measure.judged = true;
}

/// Keys that belong to one quantity.
void check_measured_quantity(Table& table, MeasureReading& r) {
  const Measure& m = r.measure;
  const auto needs = [&](const char* key, bool wanted, bool allowed, const char* why) {
    if (wanted && !table.has(key)) {
      table.reject(table.has("quantity") ? "quantity" : "statistic",
                   fmt::format("needs {}; add it", key));
    } else if (!allowed && table.has(key)) {
      table.reject(key, fmt::format("stands beside another quantity; {}", why));
    }
  };
  const bool depth = m.quantity == MeasuredQuantity::kDepth,
             aim = m.quantity == MeasuredQuantity::kDistance;
  needs("field", depth, depth || m.quantity == MeasuredQuantity::kForce,
        "only a force or depth is of a field");
  needs("to", aim, aim, "only a distance is to something");
  needs("channel", m.quantity == MeasuredQuantity::kChannel,
        m.quantity == MeasuredQuantity::kChannel, "quantity = \"channel\" measures a channel");
  needs("statistic", false, !m.is_summed(), "a path or a time is one number");
}

std::string channel_unit(const MeasureSource& source, std::size_t channel) {
  return channel < source.units.size() ? source.units[channel] : std::string();
}

/// The unit of what is measured, and the scale from SI.
void find_measure_unit(MeasureReading& r) {
  Measure& m = r.measure;
  const std::vector<TrialDevice>& devices = r.source->devices;
  device::PartUnits units;
  if (m.device < devices.size()) {
    units = device::units_of(devices[m.device].part, devices[m.device].radius);
  }
  const bool force = m.quantity == MeasuredQuantity::kForce;
  m.scale = m.quantity == MeasuredQuantity::kTime || m.quantity == MeasuredQuantity::kChannel ? 1.0
            : force ? units.newton
                    : units.metre;
  m.unit = m.quantity == MeasuredQuantity::kTime      ? std::string("s")
           : m.quantity == MeasuredQuantity::kChannel ? channel_unit(*r.source, m.channel)
           : force                                    ? std::string(units.force)
           : m.quantity == MeasuredQuantity::kSpeed   ? fmt::format("{}/s", units.place)
                                                      : std::string(units.place);
}

void check_measure_text(Table& table, MeasureReading& r) {
  if (table.has("text") && r.measure.feedback == Feedback::kNever) {
    table.reject("text", "stands alone; add feedback = \"always\" or \"practice\"");
  }
}

/// The keys that stand for themselves.
const Schema<Measure>& plain_measure_schema() {
  using M = Measure;
  static const auto schema =
      Schema<M>()
          .choice("quantity", &M::quantity,
                  {{"force", MeasuredQuantity::kForce},
                   {"depth", MeasuredQuantity::kDepth},
                   {"x", MeasuredQuantity::kX},
                   {"y", MeasuredQuantity::kY},
                   {"z", MeasuredQuantity::kZ},
                   {"speed", MeasuredQuantity::kSpeed},
                   {"distance", MeasuredQuantity::kDistance},
                   {"path", MeasuredQuantity::kPath},
                   {"time", MeasuredQuantity::kTime},
                   {"channel", MeasuredQuantity::kChannel}},
                  "What is measured: the size of the force of the fields on the device, the depth "
                  "in one of them, a place along an axis, speed, the distance to a place or moving "
                  "target, the length of the path, the time that the stage takes, or the value of "
                  "a channel")
          .choice("statistic", &M::statistic,
                  {{"mean", MeasuredStatistic::kMean},
                   {"peak", MeasuredStatistic::kPeak},
                   {"end", MeasuredStatistic::kEnd},
                   {"deviation", MeasuredStatistic::kDeviation}},
                  "Number that stands for the stage: mean, value of the greatest size, last value "
                  "or standard deviation")
          .number("last", &M::last, {0.0, 60.0}, "s",
                  "Time at the stage's end that counts, such as the last second of a held force; "
                  "0: the whole stage")
          .choice("feedback", &M::feedback,
                  {{"never", Feedback::kNever},
                   {"practice", Feedback::kPractice},
                   {"always", Feedback::kAlways}},
                  "Trials after which participants are shown the measure")
          .shown_text("text", &M::text,
                      "Words that tell participants a measure; {} is its value with the unit");
  return schema;
}

const Schema<MeasureReading>& measure_schema() {
  using R = MeasureReading;
  static const auto schema =
      Schema<R>()
          .keys_of(&R::measure, plain_measure_schema())
          .custom("stage", "Stage that is measured", read_measured_stage)
          .otherwise("the last")
          .custom("interval", "Interval that is measured, by its name", read_measured_interval)
          .otherwise("the last that is presented")
          .custom("device", "Device that is measured", read_measured_device)
          .otherwise("the first that feels the field, or the first")
          .custom("field", "Field whose force or depth is measured", read_measured_field)
          .otherwise("the sum of all fields")
          .custom("to", "Place or moving target to which the distance is measured",
                  read_measured_aim)
          .otherwise("none")
          .custom(
              "channel",
              "Quantity of a channel that is measured, \"CHANNEL.QUANTITY\", or \"CHANNEL\" for "
              "its first",
              read_measured_channel)
          .otherwise("none")
          .custom("within",
                  "Lowest and highest value of a right trial, in the unit of the measure; the "
                  "trial is right or wrong, as after an answer",
                  read_right_values)
          .otherwise("no trial is right or wrong")
          .check(check_measured_quantity)
          .check(check_measure_text);
  return schema;
}

Measure read_measure(Table& table, const std::string& name, const MeasureSource& source) {
  MeasureReading reading{&source};
  reading.measure.name = name;
  reading.measure.stage = source.stages.empty() ? 0 : source.stages.size() - 1;
  measure_schema().read(table, reading);
  find_measure_unit(reading);
  return std::move(reading.measure);
}

/// Formulas name measures.
bool is_formula_name(const std::string& name) {
  const auto part = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  return !name.empty() && std::isdigit(static_cast<unsigned char>(name.front())) == 0 &&
         std::ranges::all_of(name, part);
}

}  // namespace

std::string words_of(const Measure& measure) {
  constexpr std::array kQuantities{"force",         "depth", "place along x", "place along y",
                                   "place along z", "speed", "distance",      "path",
                                   "time",          "value"};
  constexpr std::array kStatistics{"mean", "peak", "last", "deviation of the"};
  const char* quantity = kQuantities[static_cast<std::size_t>(measure.quantity)];
  return measure.is_summed()
             ? std::string(quantity)
             : fmt::format("{} {}", kStatistics[static_cast<std::size_t>(measure.statistic)],
                           quantity);
}

/// People read millimetres, not thousandths of metres.
std::string told_value(const Measure& measure, double value) {
  const bool metres = measure.unit == "m" || measure.unit == "m/s";
  const std::string told =
      fmt::format("{:.3g}{}{}{}", metres ? 1e3 * value : value, measure.unit.empty() ? "" : " ",
                  metres ? "m" : "", measure.unit);
  std::string text = measure.text;
  const std::size_t at = text.find("{}");
  return at == std::string::npos ? text : text.replace(at, 2, told);
}

std::vector<Measure> read_measures(Table& measures, const MeasureSource& source) {
  std::vector<Measure> all;
  if (measures.keys_as_written().size() > kMostMeasures) {
    measures.reject(measures.keys_as_written().back(), "is one too many",
                    fmt::format("at most {} measures", kMostMeasures));
  }
  for (const std::string& name : measures.keys_as_written()) {
    Table table = measures.table(name);
    all.push_back(read_measure(table, name, source));
    if (!is_formula_name(name)) {
      measures.reject(name, "cannot be named by a formula", "a name of letters, digits and _");
    }
  }
  return all;
}

}  // namespace haptrial::protocols
