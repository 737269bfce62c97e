// The kind `line` against pseudo-terminals and pipes.

#include "core/channel/channel_kinds.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <clocale>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "core/base/error.h"
#include "core/base/random.h"
#include "tests/support/channel_run.h"
#include "tests/support/message_of.h"
#include "tests/support/pseudo_terminal.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::channel {
namespace {

using testing::HasSubstr;
using testing::SizeIs;
namespace fs = std::filesystem;

/// A program that prints lines into a named pipe.
class Printer {
 public:
  explicit Printer(const fs::path& pipe) {
    test::wait_until([&] { return (file_ = open(pipe.c_str(), O_WRONLY | O_NONBLOCK)) >= 0; });
  }
  ~Printer() { close(file_); }
  Printer(const Printer&) = delete;
  Printer& operator=(const Printer&) = delete;
  void print(const std::string& text) const {
    ASSERT_EQ(write(file_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }

 private:
  int file_{-1};
};

class LineChannelTest : public testing::Test {
 protected:
  LineChannelTest() { mkfifo(pipe_.c_str(), 0600); }
  std::string definition(const std::string& path, const std::string& keys) const {
    return fmt::format("[channels.hand]\nkind = \"line\"\npath = \"{}\"\n{}\n", path, keys);
  }
  std::string definition(const std::string& keys) const { return definition(pipe_.string(), keys); }

  test::TemporaryFolder folder_;
  fs::path pipe_ = folder_ / "pipe";
};

TEST_F(LineChannelTest, ValuesAreThoseThatWerePrinted) {
  test::PseudoTerminal board;
  test::ChannelRun run(definition(board.name(), R"(
quantities = { grip = "N", warm = "degC" }
columns = ["_", "warm", "grip"]
scale = { grip = 0.5 }
offset = { warm = -3.0 }
separator = " ")"));
  ASSERT_EQ(run.channel().wait_until_open(), "");
  board.send("7 3\nT: 20.25 \t 1e-3\r\n+T +1.5");  // the first line may have begun before
  run.rows(1);
  board.send("00 -8");
  board.send("\n\n T nan inf\nT  4 8\n");
  const auto& rows = run.rows(4);
  EXPECT_EQ(rows[0].values[0], 0.5e-3);
  EXPECT_EQ(rows[0].values[1], 17.25);
  EXPECT_EQ(rows[1].values[0], -4.0);
  EXPECT_EQ(rows[1].values[1], -1.5);
  EXPECT_TRUE(std::isnan(rows[2].values[0]) && std::isnan(rows[2].values[1]));
  EXPECT_EQ(rows[3].values[0], 4.0);
  EXPECT_EQ(rows[3].sample, 3u);
  EXPECT_TRUE(std::isnan(rows[3].device_time));
  EXPECT_THAT(run.of_kind(Incident::kMalformed), SizeIs(0));
  EXPECT_TRUE(run.channel().seen().live);
}

TEST_F(LineChannelTest, NumbersOfAnySizeComeBackInAnyLocale) {
  std::setlocale(LC_ALL, "de_DE.UTF-8");  // whose decimal point is a comma, if there is one
  test::ChannelRun run(definition("quantities = { a = \"1\", b = \"1\" }\nseparator = \";\""));
  const Printer printer(pipe_);
  RandomStream random(3, "numbers");
  std::vector<double> printed;
  for (int i = 0; i < 500; ++i) {
    for (int k = 0; k < 2; ++k) {
      printed.push_back((random.uniform() - 0.5) * std::pow(10.0, 40.0 * random.uniform() - 20.0));
    }
    printer.print(fmt::format("{:.17g} ;{:.17g}\n", printed[printed.size() - 2], printed.back()));
  }
  const auto& rows = run.rows(500);
  std::setlocale(LC_ALL, "C");
  for (std::size_t i = 0; i < printed.size(); ++i) {
    ASSERT_EQ(rows[i / 2].values[i % 2], printed[i]) << i;
  }
}

TEST_F(LineChannelTest, LinesThatDoNotParseAreCountedInBytes) {
  test::ChannelRun run(definition("quantities = { a = \"1\", b = \"1\" }"));
  const Printer printer(pipe_);
  std::size_t bytes = 0;
  for (const std::string bad : {"HX711 is ready", "1,2,3", "1", "1,", "1,two", "1e999,2", "0x10,2",
                                "1;2", "1 1,2", "\xff\xfe,2"}) {
    printer.print(bad + "\n1,2\n");
    bytes += bad.size();
  }
  const std::string endless(5000, '7');  // a wrong speed may have no ends of lines
  printer.print(endless);
  bytes += endless.size();
  EXPECT_THAT(run.rows(10), SizeIs(10));
  for (double now = 2.0; run.amount(Incident::kMalformed) < static_cast<double>(bytes);
       now += 2.0) {
    run.set_now(now);  // told once a second
    run.incidents(Incident::kMalformed, run.of_kind(Incident::kMalformed).size());
    usleep(1000);
  }
  EXPECT_EQ(run.amount(Incident::kMalformed), static_cast<double>(bytes));
  EXPECT_THAT(run.of_kind(Incident::kMalformed)[0].text, HasSubstr("'HX711 is ready'"));
}

TEST_F(LineChannelTest, WithoutAClockTheTimeIsBetweenTwoReadings) {
  test::ChannelRun run(definition("quantities = { a = \"1\" }\npatience = 60"));
  const Printer printer(pipe_);
  RandomStream random(5, "packs");
  std::vector<double> truth;
  double now = 1.0;
  run.set_now(now);
  for (int pack = 0; pack < 300; ++pack) {  // an adapter keeps lines for a while
    const double begin = now;
    now += 0.001 + 0.03 * random.uniform();
    std::string text;
    const int lines = 1 + pack % 4;
    for (int i = 0; i < lines; ++i) {
      truth.push_back(begin + (now - begin) * (i + random.uniform()) / lines);
      text += fmt::format("{}\n", truth.size());
    }
    run.set_now(now);
    printer.print(text);
    run.rows(truth.size());
  }
  const auto& rows = run.rows(truth.size());
  EXPECT_EQ(rows.back().values[0], static_cast<double>(truth.size()));
  EXPECT_GT(test::share_within(rows, truth), 0.95);
}

/// Sends a line each 10 ms of a board whose clock begins at `counter` and has a drift of 100 ppm.
/// The line comes 0.4 ms after the measurement, and some later.
std::vector<double> print_clocked(test::ChannelRun& run, const Printer& printer, double counter,
                                  int lines, std::uint64_t seed, double from = 1.0) {
  RandomStream random(seed, "clocked");
  std::vector<double> truth;
  const std::size_t before = run.channel().log().pushed();
  double came = from;
  for (int i = 0; i < lines; ++i) {
    truth.push_back(from + 0.01 * i * (1.0 + 100e-6));
    const double ticks = std::fmod(std::floor(counter + 0.01 * i * 1e6), 4294967296.0);
    came = std::max(came, truth.back() + 0.4e-3 - 0.5e-3 * std::log(1.0 - random.uniform()));
    run.set_now(came);
    printer.print(fmt::format("{:.0f},{}\n", ticks, i));
    run.rows(before + truth.size());
  }
  return truth;
}

constexpr const char* kClocked = R"(
quantities = { grip = "N" }
columns = ["micros", "grip"]
clock = { column = "micros", unit = "us" }
latency = 0.0004
latency_uncertainty = 0.0001)";

TEST_F(LineChannelTest, TheBoardsClockGivesTheTimesAndItsCounterMayTurn) {
  test::ChannelRun run(definition(kClocked));
  const Printer printer(pipe_);
  const auto truth = print_clocked(run, printer, 4294967296.0 - 30e6, 6000, 7);  // after 30 s
  const auto& rows = run.rows(truth.size());
  EXPECT_GT(test::share_within(rows, truth), 0.95);
  double mean = 0.0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    mean += rows[i].uncertainty / static_cast<double>(rows.size());
    ASSERT_NEAR(rows[i].device_time - rows[i - 1].device_time, 0.01, 1.1e-6) << i;
  }
  EXPECT_LT(mean, 2e-3);
  EXPECT_THAT(run.of_kind(Incident::kClockStep), SizeIs(0));
}

TEST_F(LineChannelTest, ABoardThatBeginsAnewIsAStepOfItsClock) {
  test::ChannelRun run(definition(kClocked));
  const Printer printer(pipe_);
  print_clocked(run, printer, 4294967296.0 - 60e6, 1000, 8);
  const double reset = 11.02;
  const auto truth = print_clocked(run, printer, 0.0, 1000, 9, reset);
  EXPECT_THAT(run.of_kind(Incident::kClockStep), SizeIs(1));
  EXPECT_NEAR(1e-9 * static_cast<double>(run.rows(2000).back().time_ns), truth.back(), 1e-3);
}

TEST_F(LineChannelTest, AClockInAnotherUnitIsSaidAndNotUsed) {
  test::ChannelRun run(definition(R"(
quantities = { grip = "N" }
columns = ["millis", "grip"]
clock = { column = "millis" }
patience = 60)"));
  const Printer printer(pipe_);
  std::vector<double> truth;
  for (int pack = 0; pack < 100; ++pack) {  // of eight lines, 2 ms from one to the next
    std::string text;
    for (int i = 0; i < 8; ++i) {
      truth.push_back(1.0 + 0.016 * pack + 0.002 * i);
      text += fmt::format("{:.0f},1\n", 1e6 * truth.back());  // microseconds
    }
    run.set_now(truth.back());
    printer.print(text);
    run.rows(truth.size());
  }
  EXPECT_GT(test::share_within(run.rows(truth.size()), truth), 0.95);
  const auto steps = run.of_kind(Incident::kClockStep);
  ASSERT_THAT(steps, SizeIs(5));
  EXPECT_THAT(steps.back().text, HasSubstr("is its unit right?"));
}

/// Such a clock runs too slow, so that it is late and never early.
TEST_F(LineChannelTest, AClockInTooLargeAUnitIsSaidAndNotUsed) {
  test::ChannelRun run(definition(R"(
quantities = { grip = "N" }
columns = ["millis", "grip"]
clock = { column = "millis" }
patience = 60)"));
  const Printer printer(pipe_);
  std::vector<double> truth;
  for (int line = 0; line < 200; ++line) {
    truth.push_back(1.0 + 0.04 * line);
    run.set_now(truth.back());
    printer.print(fmt::format("{:.3f},1\n", truth.back()));  // seconds
    run.rows(truth.size());
  }
  const auto steps = run.of_kind(Incident::kClockStep);
  ASSERT_THAT(steps, SizeIs(5));
  EXPECT_THAT(steps.back().text, HasSubstr("is its unit right?"));
  EXPECT_LT(1e-9 * static_cast<double>(steps.back().time_ns), 5.0);
  for (const ChannelRow& row : run.rows(truth.size())) {
    if (row.received_ns > steps.back().time_ns) {
      EXPECT_LE(1e-9 * static_cast<double>(row.received_ns - row.time_ns), row.uncertainty);
      EXPECT_LT(row.uncertainty, 0.04) << "half the time from line to line, and the line's own";
    }
  }
}

TEST_F(LineChannelTest, ALineThatComesAgainIsLeftOut) {
  test::ChannelRun run(definition(kClocked));
  const Printer printer(pipe_);
  printer.print("1000,1\n1000,1\n2000,1\n2000,1\n2000,1\n3000,1\n");
  EXPECT_EQ(run.rows(3)[2].device_time, 3e-3);
  EXPECT_EQ(run.amount(Incident::kRepeated), 3.0);
}

TEST_F(LineChannelTest, AnInstrumentIsStartedFoundAgainAndStopped) {
  auto board = std::make_unique<test::PseudoTerminal>();
  const fs::path name = folder_ / "board";
  fs::create_symlink(board->name(), name);
  test::ChannelRun run(definition(
      name.string(), "quantities = { a = \"1\" }\nstart = \"go\\n\"\nstop = \"halt\\n\""));
  const auto heard = [&] {
    std::string text;
    for (const auto& each : board->heard()) {
      text += static_cast<char>(each.byte);
    }
    return text;
  };
  test::wait_until([&] { return heard() == "go\n"; });
  board->send("0\n1\n");
  run.rows(1);
  board->unplug();
  EXPECT_THAT(run.incidents(Incident::kLost, 1)[0].text,
              HasSubstr("the instrument is disconnected"));
  EXPECT_FALSE(run.channel().seen().live);
  board = std::make_unique<test::PseudoTerminal>();
  fs::remove(name);
  fs::create_symlink(board->name(), name);
  run.set_now(3.0);
  test::wait_until([&] { return heard() == "go\n"; });
  board->send("0\n2\n");
  EXPECT_EQ(run.rows(2)[1].values[0], 2.0);
  EXPECT_EQ(run.incidents(Incident::kBack, 1)[0].amount, 3.0);
  EXPECT_THAT(run.of_kind(Incident::kLost), SizeIs(1)) << "told once";
  run.close();
  test::wait_until([&] { return heard() == "go\nhalt\n"; });
}

TEST_F(LineChannelTest, ABoardThatRestartedAndWaitsIsStartedAgain) {
  const test::PseudoTerminal board;
  test::ChannelRun run(definition(board.name(), "quantities = { a = \"1\" }\nstart = \"go\\n\""));
  test::wait_until([&] { return board.heard().size() == 3; });
  board.send("0\n1\n");
  run.rows(1);
  run.set_now(1.5);
  EXPECT_THAT(run.incidents(Incident::kLost, 1)[0].text, HasSubstr("no data come any more"));
  EXPECT_THAT(board.heard(), SizeIs(3)) << "it may be slow";
  run.set_now(3.0);
  test::wait_until([&] { return board.heard().size() == 6; });
  board.send("0\n2\n");
  EXPECT_EQ(run.rows(2)[1].values[0], 2.0);
  run.incidents(Incident::kBack, 1);
}

TEST_F(LineChannelTest, AProgramThatEndsMayBeStartedAgain) {
  test::ChannelRun run(definition("quantities = { a = \"1\" }\nrate = 2"));
  EXPECT_EQ(run.options().plan.patience, 1.5) << "three lines";
  std::make_unique<Printer>(pipe_)->print("1\n2");
  EXPECT_THAT(run.incidents(Incident::kLost, 1)[0].text, HasSubstr("has ended"));
  const Printer again(pipe_);
  again.print("3\n");
  EXPECT_EQ(run.rows(2)[1].values[0], 3.0);
  run.incidents(Incident::kBack, 1);
  run.set_now(4.0);
  EXPECT_THAT(run.incidents(Incident::kLost, 2)[1].text, HasSubstr("no data come any more"));
}

TEST_F(LineChannelTest, AnInstrumentThatCannotBeOpenedIsASentence) {
  const auto why = [&](const std::string& path, const std::string& more = "") {
    test::ChannelRun run(definition(path, "quantities = { a = \"1\" }" + more));
    return run.channel().wait_until_open();
  };
  EXPECT_THAT(why("/dev/nowhere"), HasSubstr("/dev/nowhere: No such file"));
  EXPECT_THAT(why("/dev/null"), HasSubstr("is no serial line"));
  EXPECT_THAT(why(folder_.path().string()), HasSubstr("neither a serial line nor a named pipe"));
  EXPECT_THAT(why(pipe_.string(), "\nstart = \"go\""), HasSubstr("remove `start` and `stop`"));
}

TEST_F(LineChannelTest, MistakesOfADefinitionAreSentences) {
  const auto problem = [&](const std::string& keys) {
    return test::message_of<InputError>([&] { test::channels_of(definition(keys)); });
  };
  EXPECT_THAT(problem(""), HasSubstr("channels.hand.quantities"));
  EXPECT_THAT(problem("quantities = { a = \"1\" }\nbaud = 9601"), HasSubstr("9600, 19200"));
  EXPECT_THAT(problem("quantities = { a = \"1\" }\ncolumns = [\"b\"]"),
              HasSubstr("channels.hand.columns is [b]; allowed: the columns of a line in their "
                        "order, 'a' once among them"));
  EXPECT_THAT(problem("quantities = { a = \"1\" }\ncolumns = [\"a\", \"b\"]"),
              HasSubstr("channels.hand.columns is 'b'; allowed: a and '_'"));
  EXPECT_THAT(problem("quantities = { a = \"1\" }\nclock = { column = \"t\" }"),
              HasSubstr("'t' once among them"));
  EXPECT_THAT(problem("quantities = { a = \"1\" }\nscale = { b = 2 }"), HasSubstr("scale.b"));
  EXPECT_THAT(problem("quantities = { a = \"1\" }\nseparator = \"1\""), HasSubstr("separator"));
}

}  // namespace
}  // namespace haptrial::channel
