#include "core/channel/channel_kinds.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <optional>
#include <span>
#include <thread>
#include <utility>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/base/serial_port.h"
#include "core/base/utf8.h"

namespace haptrial::channel {
namespace {

using std::chrono::milliseconds;

constexpr double kCounterTurn = 4294967296.0;  // of a counter of 32 bits [ticks]
constexpr double kCounterSlack = 1.0;          // by which a counter and ours may differ [s]
constexpr std::size_t kLongestLine = 4096;     // [bytes]
constexpr std::size_t kBytesAtOnce = 65536;
constexpr std::int64_t kMalformedEvery = 1'000'000'000;  // at most one row in this time [ns]
constexpr std::size_t kShownOfLine = 60;                 // [bytes]

/// The board's own clock, if a column has it.
struct LineClock {
  std::string column;
  double tick{1e-3};  // > 0 [s]
};

/// The keys of a channel of this kind.
struct LineOptions {
  std::string path;
  int baud{115200};
  std::vector<Quantity> quantities{};
  std::vector<std::string> columns{};
  std::string separator{","};
  std::vector<double> scales{};   // one a quantity
  std::vector<double> offsets{};  // likewise, in its unit
  std::optional<LineClock> clock{};
  std::string start{};
  std::string stop{};
  double settle{0.0};  // >= 0 [s]
  double rate{0.0};    // 0: unknown [Hz]
};

/// A number for each quantity that `key` names.
std::vector<double> read_for_each(Table& table, const std::string& key,
                                  const std::vector<Quantity>& quantities, double otherwise) {
  std::vector<double> numbers(quantities.size(), otherwise);
  Table inner = table.table(key);
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    inner.describe({quantities[i].name, "Number of this quantity", fmt::format("{:g}", otherwise)});
    if (inner.has(quantities[i].name)) {
      numbers[i] = inner.number(quantities[i].name, {-1e12, 1e12}, quantities[i].unit);
    }
  }
  return numbers;
}

const Schema<LineClock>& line_clock_schema() {
  static const auto schema =
      Schema<LineClock>()
          .text("column", &LineClock::column, "Name of the column with the board's time")
          .required()
          .choice("unit", &LineClock::tick, {{"s", 1.0}, {"ms", 1e-3}, {"us", 1e-6}},
                  "Unit of the board's time; whole numbers that start from 0 again after 2^32 are "
                  "followed");
  return schema;
}

bool is_one_of(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

/// Columns that are left out are the quantities, and each quantity and the clock have one column.
void check_columns(Table& table, LineOptions& options) {
  std::vector<std::string> wanted;
  for (const Quantity& quantity : options.quantities) {
    wanted.push_back(quantity.name);
  }
  if (options.columns.empty()) {
    options.columns = wanted;
  }
  if (options.clock) {
    wanted.push_back(options.clock->column);
  }
  for (const std::string& name : wanted) {
    if (std::ranges::count(options.columns, name) != 1) {
      table.reject("columns", fmt::format("[{}]", fmt::join(options.columns, ", ")),
                   fmt::format("the columns of a line in their order, '{}' once among them and '_' "
                               "for each that is not used",
                               name));
    }
  }
  for (const std::string& name : options.columns) {
    if (name != "_" && !is_one_of(wanted, name)) {
      table.reject(
          "columns", fmt::format("'{}'", name),
          fmt::format("{} and '_' for a column that is not used", fmt::join(wanted, ", ")));
    }
  }
}

void check_line(Table& table, LineOptions& options) {
  if (!has_serial_rate(options.baud)) {
    table.reject("baud", fmt::format("{}", options.baud),
                 "9600, 19200, 38400, 57600, 115200, 230400, 460800, 921600");
  }
  if (options.separator.empty() ||
      options.separator.find_first_of("\r\n+-.0123456789") != std::string::npos) {
    table.reject("separator", fmt::format("\"{}\"", options.separator),
                 "a text such as \",\" without digits, signs and line ends; \" \" for any blanks");
  }
  options.scales.resize(options.quantities.size(), 1.0);
  options.offsets.resize(options.quantities.size(), 0.0);
  check_columns(table, options);
}

const Schema<LineOptions>& line_schema() {
  using O = LineOptions;
  static const auto schema =
      Schema<O>()
          .text("path", &O::path,
                "Serial line or named pipe, such as \"/dev/ttyACM0\" or a name in "
                "/dev/serial/by-id, which stays the same")
          .required()
          .integer("baud", &O::baud, 1, 10'000'000, "Speed of the serial line, in bits per second")
          .custom("quantities", "Quantities in a line, each with its unit: { grip = \"N\" }",
                  [](Table& table, const std::string& key, O& o) {
                    o.quantities = read_quantities(table, key);
                  })
          .required()
          .texts("columns", &O::columns,
                 "Columns of a line in their order, by name; one that is not used is \"_\" and may "
                 "hold "
                 "any text")
          .otherwise("the quantities in their order")
          .text("separator", &O::separator,
                "Text between two numbers; blanks beside it count for nothing, and \" \" is any "
                "number of blanks or tabs")
          .custom("scale", "Factor for the numbers of a quantity: { grip = 0.01 }",
                  [](Table& table, const std::string& key, O& o) {
                    o.scales = read_for_each(table, key, o.quantities, 1.0);
                  })
          .otherwise("1")
          .custom("offset", "Value of a quantity for the number 0: { grip = -0.4 }",
                  [](Table& table, const std::string& key, O& o) {
                    o.offsets = read_for_each(table, key, o.quantities, 0.0);
                  })
          .otherwise("0")
          .table("clock", &O::clock, line_clock_schema(),
                 "The board's own clock, which makes the times of samples far better")
          .otherwise("none")
          .text("start", &O::start, "Text that is sent when the serial line has been opened")
          .otherwise("none")
          .text("stop", &O::stop, "Text that is sent before the serial line is closed")
          .otherwise("none")
          .number("settle", &O::settle, {0.0, 10.0}, "s",
                  "Time from the opening to the start text; an Arduino begins anew when its line "
                  "is opened and wants 2")
          .number("rate", &O::rate, {0.0, 20000.0}, "Hz",
                  "Lines a second, as far as known; `patience` is at least three of them")
          .check(check_line);
  return schema;
}

/// A file that is closed at the end.
class LineFile {
 public:
  explicit LineFile(int number) : number_(number) {}
  ~LineFile() {
    if (number_ >= 0) {
      ::close(number_);
    }
  }
  LineFile(const LineFile&) = delete;
  LineFile& operator=(const LineFile&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

int open_line_path(const LineOptions& options) {
  struct stat about {};
  const char* const path = options.path.c_str();
  if (::stat(path, &about) != 0) {
    throw RunError(fmt::format("{}: {}; connect the instrument", path, std::strerror(errno)));
  }
  const bool pipe = S_ISFIFO(about.st_mode);
  if (!pipe && !S_ISCHR(about.st_mode)) {
    throw RunError(fmt::format("{} is neither a serial line nor a named pipe", path));
  }
  if (pipe && !(options.start.empty() && options.stop.empty())) {
    throw RunError(
        fmt::format("{} is a pipe, to which nothing can be sent; remove `start` and `stop`", path));
  }
  const int file = pipe ? ::open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC)
                        : open_serial_port(options.path, options.baud);
  if (file < 0) {
    throw RunError(fmt::format(
        "{}: {}", path,
        errno == ENOTTY ? "is no serial line"
                        : fmt::format("{}; check that you may use it (on Debian: group dialout)",
                                      std::strerror(errno))));
  }
  return file;
}

/// Sends what the line takes within a second.
void send_line_text(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = ::write(file, text.data(), text.size());
    if (count > 0) {
      text.remove_prefix(static_cast<std::size_t>(count));
      continue;
    }
    pollfd room{file, POLLOUT, 0};
    if ((errno != EAGAIN && errno != EINTR) || ::poll(&room, 1, 1000) <= 0) {
      return;
    }
  }
}

std::string_view without_blanks(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) {
    return {};
  }
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

/// A number as programs print it, whatever the locale; also "nan" and "inf".
std::optional<double> printed_number(std::string_view text) {
  if (text.starts_with('+')) {
    text.remove_prefix(1);
  }
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) {
    return std::nullopt;
  }
  return number;
}

/// Numbers of a line, one a column. @returns whether it has as many columns, and numbers in those
/// that are used
bool parse_line(std::string_view line, const LineOptions& options, std::vector<double>& numbers) {
  const std::string& separator = options.separator;
  const bool blanks = separator == " ";
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const bool last = i + 1 == numbers.size();
    const std::size_t end = blanks ? line.find_first_of(" \t") : line.find(separator);
    if (last != (end == std::string_view::npos)) {
      return false;
    }
    if (options.columns[i] != "_") {
      const std::optional<double> number = printed_number(without_blanks(line.substr(0, end)));
      if (!number) {
        return false;
      }
      numbers[i] = *number;
    }
    if (!last) {
      line.remove_prefix(end + separator.size());
      line = blanks ? without_blanks(line) : line;
    }
  }
  return true;
}

/// Follows a counter of 32 bits over its turns.
class TickCounter {
 public:
  /// @param now_ns  when the line came: a turn takes as long by our clock; a board that began anew
  ///                does not
  double follow(double ticks, double tick, std::int64_t now_ns) {
    if (ticks < last_ && ticks >= 0.0 && last_ < kCounterTurn) {
      const double elapsed = 1e-9 * static_cast<double>(now_ns - last_ns_);
      turns_ += (ticks + kCounterTurn - last_) * tick <= elapsed + kCounterSlack ? 1.0 : 0.0;
    }
    last_ = ticks;
    last_ns_ = now_ns;
    return (turns_ * kCounterTurn + ticks) * tick;
  }

 private:
  double last_{-1.0};  // -1: there was none
  std::int64_t last_ns_{0};
  double turns_{0.0};
};

class LineSource final : public ChannelSource {
 public:
  explicit LineSource(const LineOptions& options)
      : options_(options), file_(open_line_path(options)), numbers_(options.columns.size()) {
    serial_ = ::isatty(file_.number()) == 1;
    if (serial_) {
      std::this_thread::sleep_for(std::chrono::duration<double>(options_.settle));
      ::tcflush(file_.number(), TCIFLUSH);
      send_line_text(file_.number(), options_.start);
    }
    begun_before_ = serial_;
    for (std::size_t i = 0; i < options_.quantities.size(); ++i) {
      places_.push_back(place_of(options_.quantities[i].name));
    }
  }
  ~LineSource() override {
    if (serial_) {
      send_line_text(file_.number(), options_.stop);
    }
  }

  void read(ChannelInbox& into, milliseconds patience) override {
    if (!empty_ns_) {
      empty_ns_ = into.now();
    }
    pollfd wait{file_.number(), POLLIN, 0};
    ::poll(&wait, 1, static_cast<int>(patience.count()));
    const std::int64_t empty_before = *empty_ns_;
    const bool ended = receive(into) && (wait.revents & (POLLHUP | POLLERR)) != 0;
    const std::int64_t now = into.now();
    const double waited = 1e-9 * static_cast<double>(now - empty_before);
    std::size_t begin = 0;
    for (std::size_t end; (end = text_.find_first_of("\r\n", begin)) != std::string::npos;) {
      take_line(into, without_blanks(std::string_view(text_).substr(begin, end - begin)), now,
                waited);
      begin = end + 1;
    }
    text_.erase(0, begin);
    if (text_.size() > kLongestLine) {
      note_malformed(text_);
      text_.clear();
    }
    tell_malformed(into, now);
    if (ended) {
      throw RunError(fmt::format(
          "{}: {}", options_.path,
          serial_ ? "the instrument is disconnected" : "the program that wrote to it has ended"));
    }
  }

  bool is_reopened_when_silent() const override { return serial_ && !options_.start.empty(); }

 private:
  std::size_t place_of(const std::string& column) const {
    return static_cast<std::size_t>(std::ranges::find(options_.columns, column) -
                                    options_.columns.begin());
  }

  /// Appends all that has come to the text. @returns whether nothing more can come if the other end
  /// has hung up
  bool receive(ChannelInbox& into) {
    std::array<char, 4096> bytes{};
    for (std::size_t all = 0; all < kBytesAtOnce;) {
      const std::int64_t now = into.now();
      const ssize_t count = ::read(file_.number(), bytes.data(), bytes.size());
      if (count > 0) {
        text_.append(bytes.data(), static_cast<std::size_t>(count));
        all += static_cast<std::size_t>(count);
      } else if (count == 0 || errno != EINTR) {
        empty_ns_ = now;
        return count == 0 || errno != EAGAIN;
      }
    }
    return false;
  }

  void take_line(ChannelInbox& into, std::string_view line, std::int64_t now, double waited) {
    if (line.empty()) {
      return;
    }
    if (std::exchange(begun_before_, false)) {  // half of it may be missing
      return;
    }
    if (!parse_line(line, options_, numbers_)) {
      note_malformed(line);
      return;
    }
    InstrumentSample sample;
    if (options_.clock) {
      if (line == last_line_) {
        into.note(Incident::kRepeated, 1.0);
        return;
      }
      last_line_ = line;
      sample.device_time =
          counter_.follow(numbers_[place_of(options_.clock->column)], options_.clock->tick, now);
    }
    std::array<double, kMostQuantities> values{};
    for (std::size_t i = 0; i < places_.size(); ++i) {
      values[i] = options_.scales[i] * numbers_[places_[i]] + options_.offsets[i];
    }
    sample.values = std::span(values).first(places_.size());
    sample.waited = waited;
    into.take(sample);
  }

  void note_malformed(std::string_view line) {
    if (malformed_ == 0) {
      malformed_text_ = cut_text(line, kShownOfLine);
    }
    malformed_ += line.size();
  }

  /// One row for all of a second: a line at the wrong speed is malformed all the time.
  void tell_malformed(ChannelInbox& into, std::int64_t now) {
    if (malformed_ > 0 && (!told_ns_ || now - *told_ns_ >= kMalformedEvery)) {
      told_ns_ = now;
      into.note(Incident::kMalformed, static_cast<double>(std::exchange(malformed_, 0)),
                fmt::format("'{}', in place of {} columns", malformed_text_, numbers_.size()));
    }
  }

  LineOptions options_;
  LineFile file_;
  bool serial_{false};
  std::vector<double> numbers_;           // of a line
  std::vector<std::size_t> places_;       // of each quantity among them
  std::string text_;                      // that has come and is not yet taken
  bool begun_before_{false};              // the first line may have begun before the opening
  std::optional<std::int64_t> empty_ns_;  // when nothing lay in the line, last
  TickCounter counter_;
  std::string last_line_;
  std::size_t malformed_{0};  // bytes that were not told yet
  std::string malformed_text_;
  std::optional<std::int64_t> told_ns_;
};

}  // namespace

ChannelKind line_channel() {
  return {"line", "a board or sensor that prints a line of numbers for each sample",
          [](Table& table) {
            const LineOptions options = line_schema().read(table);
            ChannelPlan plan;
            plan.quantities = options.quantities;
            plan.path = options.path;
            plan.rate = options.rate;
            if (options.rate > 0.0) {
              plan.patience = std::clamp(3.0 / options.rate, plan.patience, 60.0);
            }
            plan.open = [options] { return std::make_unique<LineSource>(options); };
            return plan;
          }};
}

}  // namespace haptrial::channel
