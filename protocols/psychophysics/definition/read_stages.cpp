#include "protocols/psychophysics/definition/read_stages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/definition/table.h"
#include "core/base/definition/table_vector.h"
#include "core/base/random.h"

namespace haptrial::protocols {
namespace {

constexpr double kLongest = 3600.0;  // [s]
constexpr Bounds kDuration{0.0, kLongest, false};
constexpr Bounds kTimeoutBounds{0.0, kLongest, true};
constexpr Bounds kSpeed{0.0, 10.0, true};

constexpr std::array<std::pair<const char*, Consequence>, 3> kConsequences{
    {{"abort", Consequence::kAbort},
     {"repeat", Consequence::kRepeat},
     {"go on", Consequence::kGoOn}}};

Consequence read_consequence(Table& table, const char* key) {
  const std::string word = table.choice(key, {"abort", "repeat", "go on"});
  for (const auto& [name, what] : kConsequences) {
    if (word == name) {
      return what;
    }
  }
  return Consequence::kAbort;
}

class StageReader {
 public:
  StageReader(Table& table, const StageSource& source) : table_(table), source_(source) {}

  NamedStage read() {
    result_.name = table_.text("name");
    if (table_.has("fields")) {
      result_.stage.fields = mask(table_, "fields", source_.fields, "field");
    }
    for (const std::string& text : texts("show")) {
      const std::string name = word(text);
      if (name == "null") {
        continue;
      }
      if (source_.sights.empty() || index_of(table_, "show", name, source_.sights, "sight") >= 0) {
        result_.show.push_back(name);
      }
    }
    Table until = table_.table("until");
    read_until(until);
    read_timeout();
    read_requirement();
    if (table_.has("onset")) {
      Table onset = table_.table("onset");
      result_.stage.onset_speed = number(onset, "speed_above", kSpeed, "m/s");
    }
    if (table_.has("sound")) {
      result_.sound = index_of(table_, "sound", table_.text("sound"), source_.sounds, "sound");
    }
    if (table_.has("marker")) {
      result_.marker = static_cast<int>(table_.integer("marker", 1, 255));
    }
    return std::move(result_);
  }

 private:
  std::vector<std::string> texts(const char* key) {
    return table_.has(key) ? table_.texts(key) : std::vector<std::string>{};
  }
  double number(Table& table, const char* key, const Bounds& bounds, const char* unit) {
    return table.number(key, bounds, unit);
  }

  std::string word(const std::string& text) const {
    return source_.word ? source_.word(text) : text;
  }

  /// A bit for each name: of one text or of an array of them.
  std::uint64_t mask(Table& table, const char* key, const std::vector<std::string>& known,
                     const char* what) {
    const std::vector<std::string> names =
        table.is_array(key) ? table.texts(key) : std::vector{table.text(key)};
    std::uint64_t bits = 0;
    for (const std::string& name : names) {
      const int index = index_of(table, key, name, known, what);
      bits |= index < 0 ? 0 : std::uint64_t{1} << static_cast<unsigned>(index);
    }
    return bits;
  }

  /// -1 for "null" and, with a problem noted, for what is not there.
  int index_of(Table& table, const char* key, const std::string& text,
               const std::vector<std::string>& known, const char* what) {
    const std::string name = word(text);
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

  void read_until(Table& table) {
    Until& until = result_.stage.until;
    int asked = 0;
    const auto has = [&](const char* key) {
      const bool there = table.has(key);
      asked += there ? 1 : 0;
      return there;
    };
    if (has("inside")) {
      until.inside = mask(table, "inside", source_.regions, "region");
    }
    if (has("contact")) {
      until.contact = mask(table, "contact", source_.fields, "field");
    }
    if (has("speed_below")) {
      until.speed_below = number(table, "speed_below", kSpeed, "m/s");
    }
    if (has("speed_above")) {
      until.speed_above = number(table, "speed_above", kSpeed, "m/s");
    }
    if (has("buttons")) {
      until.buttons = read_bits(table, "buttons");
    }
    if (has("keys")) {
      until.keys = source_.keys ? source_.keys(table, "keys") : 0;
    }
    waits_ = asked > 0;
    if (has("time")) {
      until.time = number(table, "time", kDuration, "s");
    }
    if (asked == 0) {
      table_.reject("until",
                    "names no end of the stage; state a time, a place, a contact, a speed, "
                    "buttons or keys");
    }
    if (table.has("for")) {
      until.hold = read_hold(table);
    }
    if (until.speed_above >= until.speed_below) {
      table.reject("speed_above", fmt::format("{:g} [m/s]", until.speed_above),
                   fmt::format("less than speed_below, {:g} [m/s]", until.speed_below));
    }
  }

  double read_hold(Table& table) {
    const std::vector<double> range = holds_range(table)
                                          ? table.numbers("for", kDuration, "s")
                                          : std::vector{number(table, "for", kDuration, "s")};
    longest_hold_ = range.empty() ? 0.0 : range.back();
    if (range.size() == 1) {
      return range.front();
    }
    if (range.size() != 2 || range[1] < range[0]) {
      table.reject("for", fmt::format("[{}]", fmt::join(range, ", ")),
                   "a time or [shortest, longest] [s]");
      return 0.0;
    }
    return source_.random != nullptr ? source_.random->uniform(range[0], range[1]) : range[0];
  }
  static bool holds_range(Table& table) { return table.is_array("for"); }

  void read_timeout() {
    if (table_.has("timeout")) {
      Table timeout = table_.table("timeout");
      result_.stage.timeout = number(timeout, "after", kTimeoutBounds, "s");
      result_.stage.late = read_consequence(timeout, "then");
      const double soonest = std::max(result_.stage.until.time, longest_hold_);
      if (result_.stage.timeout < soonest) {
        timeout.reject("after",
                       fmt::format("{:g}, before the stage can end", result_.stage.timeout),
                       fmt::format("at least the {:g} s that until takes", soonest));
      }
    } else if (waits_) {
      table_.reject("until", "may never come; add timeout = { after = …, then = \"abort\" }");
    }
  }

  void read_requirement() {
    if (!table_.has("require")) {
      return;
    }
    Table table = table_.table("require");
    Requirement require;
    const std::string of = table.choice("max_of", {"depth", "force", "speed"});
    require.of = of == "depth"   ? Requirement::Of::kDepth
                 : of == "force" ? Requirement::Of::kForce
                                 : Requirement::Of::kSpeed;
    const char* unit = of == "depth" ? "m" : of == "force" ? "N" : "m/s";
    if (require.of != Requirement::Of::kSpeed) {
      require.field = index_of(table, "field", table.text("field"), source_.fields, "field");
    }
    require.at_least = number(table, "at_least", kNonNegative, unit);
    require.otherwise = read_consequence(table, "else");
    result_.stage.require = require;
  }

  Table& table_;
  const StageSource& source_;
  NamedStage result_;
  bool waits_{false};         // for more than a time
  double longest_hold_{0.0};  // that `for` of until may ask [s]
};

}  // namespace

std::vector<NamedStage> read_stages(Table& root, const StageSource& source) {
  std::vector<NamedStage> stages;
  for (Table& table : root.tables("stages")) {
    NamedStage stage = StageReader(table, source).read();
    if (std::ranges::find(stages, stage.name, &NamedStage::name) != stages.end()) {
      table.reject("name", fmt::format("\"{}\"", stage.name), "a name that no other stage has");
    }
    stages.push_back(std::move(stage));
  }
  return stages;
}

}  // namespace haptrial::protocols
