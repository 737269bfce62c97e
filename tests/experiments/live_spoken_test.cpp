// Sessions whose participant only hears: the person below reads nothing but what a stand-in for
// espeak-ng was told to say, and answers by keys of the window.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/answer_rows.h"
#include "core/sound/drill_sound.h"
#include "core/sound/power_spectrum.h"
#include "core/sound/wav.h"
#include "experiments/studies/registry.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/shipped.h"
#include "tests/experiments/small_drilling.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/virtual_display.h"

namespace haptrial::experiments::live_spoken_test {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::HasSubstr;

/// A shipped experiment that is spoken, whose virtual hand leaves the answers to the keys.
std::string spoken(const std::string& name, const std::string& more = "") {
  std::string text = test::read_text(test::shipped_definition().parent_path() / (name + ".toml"));
  const std::string observer = "[observer]";
  text.insert(text.find('\n', text.find(observer)) + 1, "reaction = 60.0\n");
  return text +
         "[display]\nspoken = true\nwidth = 600\nheight = 440\n[screen]\nfull_screen = false\n"
         "[sounds]\ndevice = \"null\"\n" +
         more;
}

/// Somebody who hears a text and presses a key.
class Listener {
 public:
  Listener(fs::path file, const test::VirtualDisplay& display)
      : file_(std::move(file)), display_(display) {}

  /// Hears what was said since the last call, and answers.
  void listen() {
    std::ifstream in(file_);
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);) {
      lines.push_back(line);
    }
    for (; heard_.size() < lines.size();) {
      heard_.push_back(lines[heard_.size()]);
      answer(heard_.back().substr(heard_.back().find('\t') + 1));
    }
  }
  const std::vector<std::string>& heard() const { return heard_; }

 private:
  static bool says(const std::string& text, const std::string& words) {
    return text.find(words) != std::string::npos;
  }
  void press(unsigned long key) const {
    try {
      display_.press_key("haptrial", key);
    } catch (const std::runtime_error&) {  // the window has closed
    }
  }
  void answer(const std::string& text) {
    constexpr unsigned long kRight = 0xff53, kTab = 0xff09;
    if (says(text, "Hello.") && !std::exchange(repeated_, true)) {
      press(kTab);  // did not understand it
      return;
    }
    if (says(text, "1: ") && says(text, "2: ")) {
      enters_ = says(text, "Enter");
      press('1');
    } else if (says(text, "Move the mark")) {
      enters_ = true;
      press(kRight);
    } else if (says(text, "Type a number, then") || says(text, "Type your answer, then")) {
      enters_ = true;
      press('5');
    } else if (says(text, "Press Enter") || says(text, "Eingabe") || enters_) {
      enters_ = false;  // the echo of what was chosen, moved or typed
      press(test::VirtualDisplay::kEnter);
    }
  }

  fs::path file_;
  const test::VirtualDisplay& display_;
  std::vector<std::string> heard_;
  bool enters_{false};  // the answer is given by Enter
  bool repeated_{false};
};

class LiveSpokenTest : public testing::Test {
 protected:
  std::string run(const std::string& options) const {
    return "run '" + (folder_ / "study.toml").string() + "' --subject S01 --trials 2 --out '" +
           (folder_ / "out").string() + "' " + options;
  }
  /// Environment in which the loader finds this library.
  std::string with_library(const fs::path& library) const {
    fs::create_directory(folder_ / "lib");
    fs::create_symlink(library, folder_ / "lib/libespeak-ng.so.1");
    return "export LD_LIBRARY_PATH='" + (folder_ / "lib").string() + "' STAND_IN_SPEECH_FILE='" +
           (folder_ / "heard").string() + "'";
  }
  std::string with_speech() const {
    return with_library(fs::path(HAPTRIAL_BINARY_DIR) / "libstand_in_espeak.so");
  }
  /// A session of the listener's. @returns what was heard, each text behind its voice and a tab
  std::vector<std::string> hear_session(const std::string& options) {
    test::VirtualDisplay display(640, 480);
    test::LiveCommand session(run(options + " --window"), with_speech());
    Listener listener(folder_ / "heard", display);
    while (session.runs()) {
      listener.listen();
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    listener.listen();
    const test::CommandResult ended = session.wait();
    EXPECT_EQ(ended.status, 0) << ended.output << ended.errors;
    return listener.heard();
  }
  /// Events of speech in the file, which is whole.
  std::vector<std::string> spoken_events() const {
    const record::SessionReader file(folder_ / "out/S01.h5");
    EXPECT_TRUE(record::check_session(file, known_tables()).ok);
    std::vector<std::string> texts;
    std::int64_t last = 0;
    for (const record::EventRow& event : file.events()) {
      if (event.kind == "spoken") {
        EXPECT_GE(event.time_ns, last) << event.text;
        last = event.time_ns;
        texts.push_back(event.text);
      }
    }
    return texts;
  }
  std::vector<record::ResponseRow> responses() const {
    return record::SessionReader(folder_ / "out/S01.h5").responses();
  }

  test::TemporaryFolder folder_;
};

TEST_F(LiveSpokenTest, ABlindParticipantAnswersInGerman) {
  test::write_text(folder_ / "study.toml", spoken("first_experiment"));
  fs::copy_file(test::shipped_definition().parent_path() / "first_experiment.texts.de.toml",
                folder_ / "study.texts.de.toml");
  const std::vector<std::string> heard = hear_session("--language de");
  const std::string question = "Hat es gezogen? 1: Ja. 2: Nein.";
  EXPECT_EQ(std::ranges::count(heard, "de\t" + question), 2) << "once for each trial";
  EXPECT_THAT(heard, Contains(HasSubstr("de\tWillkommen. Folgen Sie dem")));
  EXPECT_THAT(heard, Contains("de\tVielen Dank. Die Sitzung ist zu Ende."));
  const std::vector<std::string> events = spoken_events();
  EXPECT_EQ(std::ranges::count(events, question), 2);
  ASSERT_EQ(responses().size(), 2u);
  for (const record::ResponseRow& row : responses()) {
    EXPECT_EQ(row.text, "yes");
    EXPECT_EQ(row.source, record::ResponseSource::kKey);
  }
}

TEST_F(LiveSpokenTest, PagesAndTypedNumbersAreHeardAndAnswered) {
  test::write_text(folder_ / "study.toml", spoken("viscosity_magnitude", R"([pages]
before = ["welcome", "agree", "about"]
[pages.welcome]
title = "Hello"
text = "You will stir honey."
[pages.agree]
kind = "consent"
text = "Do you take part?"
[pages.about]
kind = "questions"
[[pages.about.items]]
name = "tired"
question = "How tired are you?"
scale = [0, 100]
step = 5
ends = { low = "not at all", high = "very" }
[[pages.about.items]]
name = "age"
question = "How old are you?"
number = [1, 99]
[[pages.about.items]]
name = "words"
question = "Anything to add?"
words = true
)"));
  const std::vector<std::string> heard = hear_session("");
  EXPECT_EQ(std::ranges::count(heard, "en\tHello. You will stir honey. Press Enter to go on."), 2)
      << "again, as was asked for";
  EXPECT_THAT(heard, Contains(HasSubstr("Do you take part? 1: I agree to take part. 2: I do not")));
  EXPECT_THAT(heard, Contains(HasSubstr("How tired are you? 0: not at all. 100: very.")));
  EXPECT_THAT(heard, Contains("en\t55")) << "where the mark is";
  EXPECT_THAT(heard, Contains("en\t5")) << "what is typed";
  EXPECT_THAT(heard, Contains(HasSubstr("These were all questions")));
  const std::vector<std::string> events = spoken_events();
  EXPECT_THAT(events, Contains(HasSubstr("Anything to add?")));
  const auto asks = [](const std::string& text) {
    return text.starts_with("How strongly did it resist?");
  };
  EXPECT_EQ(std::ranges::count_if(events, asks), 2);
  const auto answers = record::SessionReader(folder_ / "out/S01.h5").rows<record::AnswerRow>();
  ASSERT_EQ(answers.size(), 4u);
  EXPECT_EQ(answers[1].value, 55.0);
  EXPECT_EQ(answers[2].value, 5.0);
  EXPECT_EQ(answers[3].text, "5");
  ASSERT_EQ(responses().size(), 2u);
  EXPECT_EQ(responses().front().value, 5.0);
}

TEST_F(LiveSpokenTest, WithoutASpeechLibraryNobodySitsInSilence) {
  test::write_text(folder_ / "study.toml", spoken("first_experiment"));
  test::write_text(folder_ / "empty", "");  // hides a library that the machine has
  const std::string environment = with_library(folder_ / "empty");
  const test::VirtualDisplay display(640, 480);
  const test::CommandResult ended = test::LiveCommand(run("--window"), environment).wait();
  EXPECT_EQ(ended.status, 2);
  EXPECT_THAT(ended.errors, HasSubstr("apt install libespeak-ng1"));
  EXPECT_FALSE(fs::exists(folder_ / "out/S01.h5.partial"));
  const std::string study = (folder_ / "study.toml").string();
  const test::CommandResult checked =
      test::LiveCommand("validate '" + study + "'", environment).wait();
  EXPECT_EQ(checked.status, 0);
  EXPECT_THAT(checked.output, HasSubstr("apt install libespeak-ng1"));
  const test::CommandResult dry = test::LiveCommand("dry-run '" + study + "' --subjects 1 --out '" +
                                                        (folder_ / "dry").string() + "'",
                                                    environment)
                                      .wait();
  EXPECT_EQ(dry.status, 0) << dry.errors;
}

TEST_F(LiveSpokenTest, WithoutAWindowThereIsNothingToSpeak) {
  test::write_text(folder_ / "study.toml", spoken("first_experiment"));
  const test::CommandResult ended = test::LiveCommand(run(""), with_speech()).wait();
  EXPECT_EQ(ended.status, 2);
  EXPECT_THAT(ended.errors, HasSubstr("add --window"));
}

}  // namespace

// The sound of a live drilling, through ALSA into a file that stands in for a sound card.

namespace {

/// A configuration of ALSA whose card is a file of raw samples.
void write_card(const fs::path& configuration, const fs::path& samples) {
  test::write_text(configuration,
                   "pcm.!default {\n  type file\n  slave.pcm { type null }\n"
                   "  file \"" +
                       samples.string() + "\"\n  format \"raw\"\n}\n");
}

std::vector<float> read_samples(const fs::path& file) {
  const std::string bytes = test::read_text(file);
  std::vector<float> samples(bytes.size() / sizeof(float));
  std::memcpy(samples.data(), bytes.data(), samples.size() * sizeof(float));
  return samples;
}

/// The frequency with the most power [Hz].
double loudest(const std::vector<float>& samples) {
  const auto spectrum = sound::power_spectrum(samples, sound::DrillSound::kRate, 4096);
  const auto peak = std::max_element(spectrum.power.begin(), spectrum.power.end());
  return spectrum.bin * static_cast<double>(peak - spectrum.power.begin());
}

TEST(LiveSoundTest, TheCardIsGivenTheDrillsSoundWhileTheLoopKeepsItsTime) {
  const test::TemporaryFolder folder;
  const std::vector<std::pair<std::string, std::string>> lines{{"card", "card = true"},
                                                               {"thin_rise", "thin_rise = 0.0"}};
  constexpr double kSeconds = 4.0;
  test::write_small_drilling(folder.path(), kSeconds, lines);
  write_card(folder / "card.conf", folder / "card.raw");
  const auto start = std::chrono::steady_clock::now();
  test::LiveCommand session("run '" + (folder / "study.toml").string() + "' --subject S01 --out '" +
                                (folder / "out").string() + "'",
                            "export ALSA_CONFIG_PATH='" + (folder / "card.conf").string() + "'");
  const test::CommandResult ended = session.wait();
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
  ASSERT_EQ(ended.status, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr(" 0 lost records"));

  const std::vector<float> samples = read_samples(folder / "card.raw");
  constexpr double kRate = sound::DrillSound::kRate;
  EXPECT_GT(static_cast<double>(samples.size()), 0.5 * kSeconds * kRate);
  EXPECT_LT(static_cast<double>(samples.size()), (passed.count() + 1.0) * kRate)
      << "no faster than it is heard";
  const auto loud = [](float x) { return std::abs(x) > 1e-4F; };
  EXPECT_GT(std::count_if(samples.begin(), samples.end(), loud), kSeconds * kRate / 8);

  // The strongest line is the table's: a load slows it to 0.88 of what it is in the air at most.
  const sound::Spectrum free = sound::default_sound().of(sound::Burr::kCutting).free[0].spectrum;
  const sound::Peak strongest =
      *std::max_element(free.peaks.begin(), free.peaks.begin() + free.count,
                        [](const auto& a, const auto& b) { return a.amplitude < b.amplitude; });
  const double heard = loudest(samples);
  EXPECT_GT(heard, 0.86 * strongest.frequency);
  EXPECT_LT(heard, 1.02 * strongest.frequency);

  // Sound according to the record, by another way.
  const fs::path file = folder / "out" / "S01.h5";
  const fs::path track = folder / "track.wav";
  const test::CommandResult replay =
      test::run_command("haptrial replay '" + file.string() + "' --sound '" + track.string() + "'");
  ASSERT_EQ(replay.status, 0) << replay.errors;
  EXPECT_THAT(replay.output, HasSubstr("the same bone"));
  EXPECT_NEAR(heard, loudest(sound::read_recording(track).samples), 0.03 * heard);
}

}  // namespace
}  // namespace haptrial::experiments::live_spoken_test
